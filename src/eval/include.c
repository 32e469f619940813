/* Files inside files, each read once. */
#include "config.h"

#include "base/buffer.h"
#include "base/fence.h"
#include "base/file.h"
#include "eval/context.h"
#include "syntax/syntax.h"

/* Includes may nest this deep. */
enum { INCLUDES_LIMIT = 32 };

/* A file of the scene.  Its names outlive its evaluation: a later include brings them again. */
struct module {
    struct module *next;  /* the one met before */
    struct module *outer; /* the file whose include this answers; NULL: the scene's own */
    struct file_id id;
    bool known;   /* id is told: not standard input */
    bool reading; /* not at its end yet */
    const char *path;
    struct ast *tree; /* the description's; NULL: it could not be read */
    struct arena arena;
    struct scope scope;
};

static struct module *module_new(struct eval *e, const char *path)
{
    struct module *m = mem_zalloc(1, sizeof *m);
    m->next = e->modules;
    m->outer = e->reading;
    m->path = arena_copy(&e->out->arena, path, strlen(path));
    m->known = file_identify(path, &m->id);
    m->reading = true;
    return e->modules = m;
}

void modules_begin(struct eval *e, const char *path)
{
    e->reading = module_new(e, path);
    e->scratch = &e->reading->arena;
    scope_open(e, &e->builtins, NULL);
    builtins_bind(e);
    scope_open(e, &e->reading->scope, &e->builtins);
}

void modules_end(struct eval *e)
{
    for (struct module *m = e->modules, *next; m; m = next) {
        next = m->next;
        map_free(&m->scope.map);
        arena_free(&m->arena);
        free(m);
    }
    map_free(&e->builtins.map);
}

bool modules_inside(const struct eval *e)
{
    return e->reading->outer != NULL;
}

static struct module *find_module(const struct eval *e, const char *path)
{
    struct file_id id;
    struct module *m = file_identify(path, &id) ? e->modules : NULL;
    while (m && !(m->known && m->id.device == id.device && m->id.inode == id.inode))
        m = m->next;
    return m;
}

/* ---- which file ---- */

/* A name that another machine would have found. */
static void explain_missing(const struct eval *e, struct diag_entry *entry,
                            const struct ast_node *string, const char *path)
{
    size_t n = strlen(path), from = n - (string->text.n < n ? string->text.n : n);
    const struct file_fence *fence = e->options->sources->fence;
    bool ends = string->text.n > 0 && str_is(string->text, path + from) &&
                !fence_refusal(fence, string->text);
    char *meant = ends ? file_meant(fence, path, from) : NULL;
    char *near = ends && !meant ? file_nearest(fence, path) : NULL;
    if (meant)
        diag_note(entry, "there is '%s'", meant);
    else if (near)
        diag_note(entry, "did you mean '%s'?", near + from);
    if (meant || near)
        diag_fix(entry, string->span, DIAG_FIX_MAYBE, "\"%s\"", (meant ? meant : near) + from);
    free(meant);
    free(near);
}

/* The first that can be read: beside the file that spells the name, then in the folders of -I.
 * The caller frees; NULL after reporting. */
static char *find_file(struct eval *e, const struct ast_node *string)
{
    const char *beside = srcmap_source(e->diag->sources, string->span.begin)->name;
    struct str name = string->text;
    const struct file_fence *fence = e->options->sources->fence;
    const char *refusal = name.n ? fence_refusal(fence, name) : "the name is empty", *other;
    const char *reason = refusal;
    char *path = file_resolve(beside, name.at, name.n);
    if (!refusal && file_readable(fence, path, &reason))
        return path;
    for (size_t i = 0; !refusal && i < e->options->folder_count; i++) {
        struct buffer folder = {0};
        buffer_printf(&folder, "%s/%c", e->options->folders[i], 0);
        char *inside = file_resolve(folder.at, name.at, name.n);
        buffer_free(&folder);
        if (file_readable(fence, inside, &other)) {
            free(path);
            return inside;
        }
        free(inside);
    }
    struct diag_entry *entry = diag_report(e->diag, DIAG_FILE_MISSING, string->span,
                                           "could not read '%s': %s", path, reason);
    if (e->options->folder_count)
        diag_note(entry, "nor is it in a folder of -I");
    explain_missing(e, entry, string, path);
    e->out->incomplete = e->names_lost = true;
    free(path);
    return NULL;
}

/* "a -> b -> a", from the file that closes the circle. */
static void add_chain(struct buffer *text, const struct module *m, const struct module *first)
{
    if (m != first)
        add_chain(text, m->outer, first);
    buffer_printf(text, "%s -> ", m->path);
}

static void report_cycle(struct eval *e, const struct ast_node *string, const struct module *m)
{
    struct buffer text = {0};
    add_chain(&text, e->reading, m);
    buffer_puts(&text, m->path);
    diag_report(e->diag, DIAG_RECURSION, string->span, "the file includes itself: %.*s",
                (int)text.n, text.at);
    buffer_free(&text);
}

static unsigned nesting(const struct eval *e)
{
    unsigned n = 0;
    for (const struct module *m = e->reading; m->outer; m = m->outer)
        n++;
    return n;
}

/* ---- its content ---- */

static void eval_file(struct eval *e, const struct ast_node *string, const char *path)
{
    const struct source *s =
        syntax_load(e->options->sources, path, DIAG_FILE_MISSING, string->span, e->diag);
    if (!s) {
        e->out->incomplete = e->names_lost = true;
        return;
    }
    struct ast *ast = mem_zalloc(1, sizeof *ast);
    vec_push(&e->out->included, ast);
    e->reading->tree = ast;
    bool parsed = syntax_parse(s, ast, e->diag);
    e->out->incomplete |= !parsed;
    if (!ast->xml)
        eval_statements(e, ast->statements);
    else if (parsed)
        eval_xml_parts(e, ast->statements);
}

/* The file's names lie in its own scope and memory, inside the includer's file: not inside the loop
 * or group around the include, which end before a later include asks for the names again. */
static struct module *read_module(struct eval *e, const struct ast_node *string, const char *path)
{
    struct module *outer = e->reading, *m = module_new(e, path);
    struct scope *scope = e->scope;
    struct arena *scratch = e->scratch;
    unsigned inside = e->inside;
    struct frame frame;
    frame_open(e, &frame, DIAG_FRAME_INCLUDE, string->span);
    e->reading = m;
    e->scratch = &m->arena;
    e->inside = 0;
    scope_open(e, &m->scope, &outer->scope);
    eval_file(e, string, path);
    e->scope = scope;
    e->scratch = scratch;
    e->inside = inside;
    e->reading = outer;
    m->reading = false;
    frame_close(e, &frame);
    return m;
}

void eval_include(struct eval *e, const struct ast_node *node)
{
    const struct ast_node *string = node->children;
    char *path = find_file(e, string);
    if (!path)
        return;
    struct module *m = find_module(e, path);
    if (m && m->reading)
        report_cycle(e, string, m);
    else if (!m && nesting(e) == INCLUDES_LIMIT) {
        diag_report(e->diag, DIAG_TOO_DEEP, string->span, "includes nested deeper than %d levels",
                    INCLUDES_LIMIT);
        e->names_lost = true;
    } else {
        m = m ? m : read_module(e, string, path);
        if (m->tree)
            desc_set_brought(e->out, node, m->tree);
        scope_import(e, &m->scope, string->span);
    }
    free(path);
}
