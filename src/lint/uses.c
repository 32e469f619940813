/* Names of the native language: what is defined and never used, what hides another name, and
 * conditions that no name makes vary.
 *
 * The tree is walked as evaluation would walk it if every branch were taken and every body run
 * once.  Bodies of functions and templates see what their scope holds in the end, so they come
 * last. */
#include "config.h"

#include "eval/signature.h"
#include "lint/checks.h"

struct definition {
    struct str name;
    struct span span;
    const struct ast_node *node; /* the statement; loops and parameters: what names it */
    bool here;                   /* in the file itself */
    bool used, varies;
    bool running; /* its own body does not use it */
};

/* An include of the file itself. */
struct inclusion {
    const struct ast_node *node;
    bool used;
};

/* The includes that bring a name. */
struct bringer {
    struct bringer *next;
    struct inclusion *inclusion;
};

struct entry {
    struct entry *next; /* the one after it in its region */
    struct definition *definition;
    struct bringer *bringers;
};

struct region {
    struct region *parent;
    struct map map; /* to struct entry */
    struct entry *first, **end;
    VEC(struct definition *) bodies; /* to be walked at the end */
};

/* A file that is included, walked once. */
struct module {
    struct region region;
    struct module *next;
    bool makes; /* objects, or asserts something */
};

struct walk {
    const struct lint *l;
    struct arena arena;
    struct region *region, *file;
    struct map modules; /* tree to module */
    struct module *newest;
    VEC(struct inclusion *) inclusions; /* in the file itself */
    bool here;                          /* walking the file itself */
    bool makes;                         /* as in struct module */
    bool varies;                        /* so does what was walked since this was last reset */
    bool lost;                          /* a file that may use any name is not known */
    bool part;                          /* the file is one of definitions, which others use */
};

static void visit(struct walk *w, const struct ast_node *node);

static void visit_all(struct walk *w, const struct ast_node *first)
{
    for (const struct ast_node *n = first; n; n = n->next)
        visit(w, n);
}

/* ---- looking up ---- */

static const struct entry *find(const struct region *first, struct str name)
{
    for (const struct region *r = first; r; r = r->parent) {
        const struct entry *e = map_get(&r->map, name);
        if (e)
            return e;
    }
    return NULL;
}

/* True when something of this name is defined. */
static bool use(struct walk *w, struct str name)
{
    const struct entry *e = find(w->region, name);
    if (!e)
        return false;
    if (!e->definition->running)
        e->definition->used = true;
    for (const struct bringer *b = e->bringers; b; b = b->next)
        b->inclusion->used = true;
    w->varies |= e->definition->varies;
    return true;
}

/* ---- defining ---- */

static struct entry *add(struct walk *w, struct definition *d)
{
    struct entry *e = arena_zalloc(&w->arena, 1, sizeof *e);
    e->definition = d;
    *w->region->end = e;
    w->region->end = &e->next;
    map_set(&w->region->map, d->name, e);
    return e;
}

static bool is_overridden(const struct walk *w, struct span name)
{
    for (size_t i = 0; i < w->l->desc->overridden.n; i++)
        if (w->l->desc->overridden.at[i].begin == name.begin)
            return true;
    return false;
}

/* A name defined behind the body that has an inner one of the same name is not hidden from it. */
static void report_hiding(struct walk *w, const struct definition *inner)
{
    const struct entry *e = find(w->region->parent, inner->name);
    const struct definition *outer = e ? e->definition : NULL;
    if (!inner->here || !outer || (outer->here && outer->span.begin > inner->span.begin))
        return;
    struct diag_entry *entry =
        diag_report(w->l->diag, DIAG_SHADOWED_NAME, inner->span,
                    "'%.*s' hides the one of an outer scope", STR_ARG(inner->name));
    diag_label(entry, outer->span, "the outer one is here");
}

/* A function hides one of the language; of values a reader knows pi only. */
static void report_hiding_language(struct walk *w, const struct definition *d)
{
    bool function = d->node->kind == AST_FN || d->node->kind == AST_DEFINE;
    if (d->here && (function ? signature_is_function(d->name) : str_is(d->name, "pi")))
        diag_report(w->l->diag, DIAG_SHADOWED_NAME, d->span, "'%.*s' hides the one of the language",
                    STR_ARG(d->name));
}

static struct definition *define(struct walk *w, const struct ast_node *node, bool varies)
{
    struct definition *d = arena_zalloc(&w->arena, 1, sizeof *d);
    *d = (struct definition){.name = node->name,
                             .span = node->name_span,
                             .node = node,
                             .here = w->here,
                             .varies = varies || !w->here,
                             .used = is_overridden(w, node->name_span)};
    report_hiding(w, d);
    report_hiding_language(w, d);
    add(w, d);
    return d;
}

/* ---- regions ---- */

static void open(struct walk *w, struct region *r, struct region *parent)
{
    *r = (struct region){.parent = parent, .end = &r->first};
    w->region = r;
}

/* One whose name begins with '_' is not meant to be used. */
static void report_parameters(struct walk *w, const struct region *body)
{
    for (const struct entry *e = body->first; e; e = e->next) {
        const struct definition *d = e->definition;
        if (d->node->kind == AST_PARAMETER && !d->used && d->here && !w->lost && *d->name.at != '_')
            diag_report(w->l->diag, DIAG_UNUSED_PARAMETER, d->span,
                        "the parameter '%.*s' is never used", STR_ARG(d->name));
    }
}

/* The values parameters have of themselves, and the body. */
static void run_body(struct walk *w, struct definition *d, struct region *home)
{
    struct region inner;
    open(w, &inner, home);
    d->running = true;
    bool makes = w->makes;
    const struct ast_node *n = d->node->children;
    for (; n->kind == AST_PARAMETER; n = n->next) {
        visit_all(w, n->children);
        define(w, n, true);
    }
    visit(w, n);
    report_parameters(w, &inner);
    w->makes = makes;
    d->running = false;
    vec_free(&inner.bodies); /* a body's own were walked with its statements */
    map_free(&inner.map);
    w->region = home;
}

static void run_bodies(struct walk *w)
{
    struct region *r = w->region;
    for (size_t i = 0; i < r->bodies.n; i++)
        run_body(w, r->bodies.at[i], r);
    vec_free(&r->bodies);
}

static void report_unused(struct walk *w, const struct definition *d)
{
    static const struct {
        enum diag_code code;
        const char *what;
    } rules[AST_KINDS] = {
        [AST_LET] = {DIAG_UNUSED_LET, "value"},
        [AST_PARAM] = {DIAG_UNUSED_PARAM, "param"},
        [AST_FN] = {DIAG_UNUSED_FN, "function"},
        [AST_DEFINE] = {DIAG_UNUSED_DEFINE, "template"},
        [AST_MATERIAL] = {DIAG_UNUSED_MATERIAL, "material"},
        [AST_TEXTURE] = {DIAG_UNUSED_TEXTURE, "texture"},
    };
    bool exported = w->part && w->region == w->file;
    if (d->used || !d->here || w->lost || exported || !rules[d->node->kind].what)
        return;
    struct diag_entry *e =
        diag_report(w->l->diag, rules[d->node->kind].code, d->span, "the %s '%.*s' is never used",
                    rules[d->node->kind].what, STR_ARG(d->name));
    lint_remove(w->l, e, d->node->span, DIAG_FIX_MAYBE);
}

static void close(struct walk *w)
{
    run_bodies(w);
    for (const struct entry *e = w->region->first; e; e = e->next)
        if (!e->bringers)
            report_unused(w, e->definition);
    map_free(&w->region->map);
    w->region = w->region->parent;
}

/* ---- values ---- */

static void visit_name(struct walk *w, const struct ast_node *node)
{
    use(w, node->name);
}

/* What a function of the scene gives may vary with anything. */
static void visit_call(struct walk *w, const struct ast_node *node)
{
    w->varies |= use(w, node->name);
    visit_all(w, node->children);
}

static void visit_comprehension(struct walk *w, const struct ast_node *node)
{
    struct region inner;
    visit_all(w, node->children->next);
    open(w, &inner, w->region);
    define(w, node, true);
    visit(w, node->children);
    close(w);
}

static void visit_condition(struct walk *w, const struct ast_node *condition)
{
    bool before = w->varies;
    w->varies = false;
    visit(w, condition);
    if (!w->varies && w->here) {
        struct diag_entry *e = diag_report(w->l->diag, DIAG_CONSTANT_CONDITION, condition->span,
                                           "this is always the same: nothing in it varies");
        diag_note(e, "a 'param' can be changed by -D");
    }
    w->varies |= before;
}

static void visit_conditional(struct walk *w, const struct ast_node *node)
{
    visit_condition(w, node->children);
    visit_all(w, node->children->next);
}

/* ---- statements ---- */

static void visit_let(struct walk *w, const struct ast_node *node)
{
    bool before = w->varies;
    w->varies = node->kind == AST_PARAM;
    visit_all(w, node->children);
    define(w, node, w->varies);
    w->varies = before;
}

static void visit_routine(struct walk *w, const struct ast_node *node)
{
    struct definition *d = define(w, node, false);
    vec_push(&w->region->bodies, d);
}

/* The members of a body, perhaps with the variable of a loop. */
static void visit_body(struct walk *w, const struct ast_node *members,
                       const struct ast_node *variable)
{
    struct region inner;
    open(w, &inner, w->region);
    if (variable)
        define(w, variable, true);
    visit_all(w, members);
    close(w);
}

static void visit_for(struct walk *w, const struct ast_node *node)
{
    visit(w, node->children);
    visit_body(w, node->children->next->children, node);
}

static void visit_if(struct walk *w, const struct ast_node *node)
{
    visit_condition(w, node->children);
    for (const struct ast_node *n = node->children->next; n; n = n->next)
        visit(w, n);
}

static void visit_bare_body(struct walk *w, const struct ast_node *node)
{
    visit_body(w, node->children, NULL);
}

static void visit_block(struct walk *w, const struct ast_node *node)
{
    if (str_is(node->name, "group")) {
        visit_body(w, node->children, NULL);
        return;
    }
    w->makes = true;
    visit_all(w, node->children);
}

static void visit_use(struct walk *w, const struct ast_node *node)
{
    w->makes = true;
    use(w, node->name);
    visit_all(w, node->children);
}

static void visit_construct(struct walk *w, const struct ast_node *node)
{
    use(w, node->name);
    visit_all(w, node->children);
}

static void visit_assert(struct walk *w, const struct ast_node *node)
{
    w->makes = true;
    visit_all(w, node->children);
}

/* ---- includes ---- */

static bool holds_objects(const struct ast_node *root)
{
    for (const struct ast_node *n = root ? root->children : NULL; n; n = n->next)
        if ((str_is(n->name, "surfaces") || str_is(n->name, "lights")) && n->kind == AST_BLOCK)
            return true;
    return false;
}

/* The file's names see those of the file that includes it first. */
static struct module *walk_module(struct walk *w, const struct ast *tree)
{
    const struct str key = {(const char *)&tree->source, sizeof tree->source};
    struct module *m = map_get(&w->modules, key);
    if (m)
        return m;
    m = arena_zalloc(&w->arena, 1, sizeof *m);
    m->next = w->newest;
    w->newest = m;
    map_set(&w->modules, key, m);
    struct region *region = w->region, *file = w->file;
    bool here = w->here, makes = w->makes;
    open(w, &m->region, file);
    w->file = &m->region;
    w->here = w->makes = false;
    if (tree->xml)
        w->makes = holds_objects(tree->statements);
    else
        visit_all(w, tree->statements);
    run_bodies(w);
    m->makes = w->makes;
    w->makes |= makes;
    w->here = here;
    w->file = file;
    w->region = region;
    return m;
}

/* A name that two includes bring is brought by both. */
static void import(struct walk *w, const struct module *m, struct inclusion *inclusion)
{
    for (const struct entry *e = m->region.first; e; e = e->next) {
        struct entry *own = map_get(&w->region->map, e->definition->name);
        if (!own)
            own = add(w, e->definition);
        struct bringer *b = arena_alloc(&w->arena, sizeof *b);
        *b = (struct bringer){own->bringers, inclusion};
        own->bringers = b;
    }
}

static void visit_include(struct walk *w, const struct ast_node *node)
{
    const struct ast *tree = desc_brought(w->l->desc, node);
    struct inclusion *i = arena_zalloc(&w->arena, 1, sizeof *i);
    if (!tree) { /* in a branch that was not taken */
        w->lost = true;
        return;
    }
    const struct module *m = walk_module(w, tree);
    *i = (struct inclusion){.node = node, .used = m->makes};
    if (w->here)
        vec_push(&w->inclusions, i);
    import(w, m, i);
}

static void report_inclusions(const struct walk *w)
{
    for (size_t i = 0; i < w->inclusions.n; i++) {
        const struct inclusion *inclusion = w->inclusions.at[i];
        if (inclusion->used || w->lost || w->part)
            continue;
        struct diag_entry *e = diag_report(w->l->diag, DIAG_UNUSED_INCLUDE, inclusion->node->span,
                                           "nothing of this file is used, and it makes no objects");
        lint_remove(w->l, e, inclusion->node->span, DIAG_FIX_MAYBE);
    }
}

/* ---- any ---- */

typedef void visitor(struct walk *w, const struct ast_node *node);
static visitor *const visitors[AST_KINDS] = {
    [AST_INCLUDE] = visit_include,
    [AST_LET] = visit_let,
    [AST_PARAM] = visit_let,
    [AST_MATERIAL] = visit_let,
    [AST_TEXTURE] = visit_let,
    [AST_FN] = visit_routine,
    [AST_DEFINE] = visit_routine,
    [AST_ASSERT] = visit_assert,
    [AST_FOR] = visit_for,
    [AST_IF] = visit_if,
    [AST_BODY] = visit_bare_body,
    [AST_USE] = visit_use,
    [AST_BLOCK] = visit_block,
    [AST_NAME] = visit_name,
    [AST_CALL] = visit_call,
    [AST_CONSTRUCT] = visit_construct,
    [AST_COMPREHENSION] = visit_comprehension,
    [AST_CONDITIONAL] = visit_conditional,
};

/* As deep as the tree, which the parser bounds. */
static void visit(struct walk *w, const struct ast_node *node)
{
    if (visitors[node->kind])
        visitors[node->kind](w, node);
    else
        visit_all(w, node->children);
}

void lint_uses(const struct lint *l)
{
    struct walk w = {.l = l, .here = true, .part = desc_is_part(l->desc, l->ast)};
    struct region top;
    if (l->ast->xml)
        return;
    open(&w, &top, NULL);
    w.file = &top;
    visit_all(&w, l->ast->statements);
    close(&w);
    report_inclusions(&w);
    for (struct module *m = w.newest; m; m = m->next)
        map_free(&m->region.map);
    map_free(&w.modules);
    vec_free(&w.inclusions);
    arena_free(&w.arena);
}

/* ---- textures of XML, which numbers name ---- */

static void mark(bool *used, const struct desc_object *o, enum schema_prop_id id)
{
    const struct desc_value *v = desc_get(o, id);
    if (v)
        used[v->object->number] = true;
}

void lint_unused_textures(const struct lint *l)
{
    const struct desc *d = l->desc;
    bool *used = mem_zalloc(d->textures.n, sizeof *used);
    for (size_t i = 0; i < d->materials.n; i++)
        mark(used, d->materials.at[i], PROP_TEXTURE);
    for (size_t i = 0; i < d->surfaces.n; i++)
        mark(used, d->surfaces.at[i], PROP_NORMAL_MAP);
    for (size_t i = 0; l->ast->xml && i < d->textures.n; i++)
        if (!used[i])
            diag_report(l->diag, DIAG_UNUSED_TEXTURE, d->textures.at[i]->span,
                        "texture %zu is never used", i);
    free(used);
}

/* ---- what `default` gives ---- */

static struct str place_of(const struct desc_prop *p)
{
    return (struct str){(const char *)&p->value.span, sizeof p->value.span};
}

static void mark_taken(struct map *taken, struct desc_object *const *objects, size_t n)
{
    for (size_t i = 0; i < n; i++)
        for (const struct desc_prop *p = objects[i]->props; p; p = p->next)
            if (p->inherited)
                map_set(taken, place_of(p), taken);
}

static bool is_taken(const struct map *taken, const struct desc_object *o)
{
    for (const struct desc_prop *p = o->props; p; p = p->next)
        if (map_get(taken, place_of(p)))
            return true;
    return false;
}

/* One in a template counts as used when any use of the template made it so. */
void lint_unused_defaults(const struct lint *l)
{
    const struct desc *d = l->desc;
    struct map taken = {0};
    if (!d->defaults.n || desc_is_part(d, l->ast))
        return;
    mark_taken(&taken, d->textures.at, d->textures.n);
    mark_taken(&taken, d->materials.at, d->materials.n);
    mark_taken(&taken, d->lights.at, d->lights.n);
    mark_taken(&taken, d->surfaces.at, d->surfaces.n);
    mark_taken(&taken, &d->camera, d->camera != NULL);
    mark_taken(&taken, &d->settings, d->settings != NULL);
    for (size_t i = 0; i < d->defaults.n; i++) {
        const struct desc_object *o = d->defaults.at[i];
        if (!lint_is_here(l, o->span) || is_taken(&taken, o))
            continue;
        l->diag->frame = o->frame;
        diag_report(l->diag, DIAG_UNUSED_DEFAULT, o->span,
                    "no %s takes anything from this 'default'", schema_kind_name(o->kind, o->xml));
    }
    l->diag->frame = NULL;
    map_free(&taken);
}
