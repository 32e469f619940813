/* Diagnostics as a SARIF 2.1.0 log (OASIS Standard, 2020): one run, its rules, the results of all
 * files. */
#include "config.h"

#include "diag/print.h"

#include <jansson.h>

#define SCHEMA \
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"

static json_t *message_of(const char *text)
{
    json_t *j = json_string(text);
    return json_pack("{s:o}", "text", j ? j : json_string("(not UTF-8)"));
}

/* File names become references: what a URI does not hold is percent-encoded.  What is no file has
 * its name in angles. */
static json_t *uri_of(const char *name)
{
    if (*name == '<')
        return json_stringn(name + 1, strcspn(name + 1, " >"));
    static const char plain[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
    size_t n = strlen(name), at = 0;
    char *text = mem_alloc(3 * n + 1, 1);
    for (size_t i = 0; i < n; i++) {
        if (strchr(plain, name[i])) {
            text[at++] = name[i];
        } else {
            snprintf(text + at, 4, "%%%02X", (unsigned char)name[i]);
            at += 3;
        }
    }
    json_t *j = json_stringn(text, at);
    free(text);
    return j;
}

/* NULL where the span is no place in a text. */
static json_t *physical_location(const struct diag *d, struct span span)
{
    struct location begin = srcmap_locate(d->sources, span.begin);
    struct location end = srcmap_locate(d->sources, span.end);
    if (!begin.source || !end.source)
        return NULL;
    json_t *region =
        json_pack("{s:i, s:i, s:i, s:i, s:I, s:I}", "startLine", begin.line, "startColumn",
                  begin.column, "endLine", end.line, "endColumn", end.column, "byteOffset",
                  (json_int_t)(span.begin - begin.source->base), "byteLength",
                  (json_int_t)(span.end - span.begin));
    return json_pack("{s:{s:o}, s:o}", "artifactLocation", "uri", uri_of(begin.source->name),
                     "region", region);
}

static void append_location(json_t *list, const struct diag *d, struct span span, const char *text)
{
    json_t *physical = physical_location(d, span), *location = json_object();
    if (physical)
        json_object_set_new(location, "physicalLocation", physical);
    if (text)
        json_object_set_new(location, "message", message_of(text));
    json_array_append_new(list, location);
}

static json_t *related_of(const struct diag *d, const struct diag_entry *e)
{
    json_t *list = json_array();
    for (size_t i = 0; i < e->labels.n; i++)
        append_location(list, d, e->labels.at[i].span, e->labels.at[i].text);
    for (size_t i = 0; i < e->notes.n; i++)
        append_location(list, d, (struct span){0, 0}, e->notes.at[i]);
    return list;
}

/* The way to a finding, outermost first, as SARIF wants call stacks: innermost first. */
static json_t *stacks_of(const struct diag *d, const struct diag_entry *e)
{
    json_t *frames = json_array();
    for (size_t i = 0; i < e->frames.n; i++) {
        json_t *list = json_array();
        append_location(list, d, e->frames.at[i].span, e->frames.at[i].text);
        json_array_append_new(frames, json_pack("{s:O}", "location", json_array_get(list, 0)));
        json_decref(list);
    }
    return json_pack("[{s:o}]", "frames", frames);
}

static json_t *replacement_of(const struct diag *d, const struct diag_fixit *f)
{
    json_t *physical = physical_location(d, f->span);
    json_t *replacement =
        json_pack("{s:O, s:o}", "deletedRegion", json_object_get(physical, "region"),
                  "insertedContent", message_of(f->text));
    json_decref(physical);
    return replacement;
}

/* True when it replaces what an earlier one does: they are alternatives. */
static bool is_alternative(const struct diag_entry *e, size_t i)
{
    for (size_t k = 0; k < i; k++)
        if (e->fixits.at[k].span.begin == e->fixits.at[i].span.begin)
            return true;
    return false;
}

static void add_quoted(struct buffer *out, const char *before, struct str text)
{
    enum { MOST = 60 };
    size_t n = text.n > MOST ? MOST : text.n;
    while (n < text.n && n > 0 && (text.at[n] & 0xC0) == 0x80)
        n--;
    buffer_printf(out, "%s'%.*s%s'", before, (int)n, text.at, n < text.n ? "..." : "");
}

/* What is done, in words. */
static json_t *description_of(const struct diag *d, const struct diag_fixit *f)
{
    struct buffer words = {0};
    struct str gone = srcmap_text(d->sources, f->span), come = str_of(f->text);
    if (gone.n)
        add_quoted(&words, come.n ? "replace " : "remove ", str_trim(gone));
    if (come.n)
        add_quoted(&words, gone.n ? " by " : "insert ", str_trim(come));
    buffer_printf(&words, "%s%c", f->kind == DIAG_FIX_SAFE ? "" : ", if that is what was meant", 0);
    json_t *message = message_of(words.at);
    buffer_free(&words);
    return message;
}

/* A change of one text: the fix-it's own, and with the first all that is done together. */
static json_t *fix_of(const struct diag *d, const struct diag_entry *e, size_t i)
{
    const struct diag_fixit *f = &e->fixits.at[i];
    const struct source *source = srcmap_source(d->sources, f->span.begin);
    json_t *list = json_array();
    for (size_t k = i; k < e->fixits.n; k++)
        if (k == i || (i == 0 && !is_alternative(e, k) &&
                       srcmap_source(d->sources, e->fixits.at[k].span.begin) == source))
            json_array_append_new(list, replacement_of(d, &e->fixits.at[k]));
    return json_pack("{s:o, s:[{s:{s:o}, s:o}]}", "description", description_of(d, f),
                     "artifactChanges", "artifactLocation", "uri", uri_of(source->name),
                     "replacements", list);
}

static json_t *fixes_of(const struct diag *d, const struct diag_entry *e)
{
    json_t *list = json_array();
    for (size_t i = 0; i < e->fixits.n; i++)
        if (span_known(e->fixits.at[i].span) && (i == 0 || is_alternative(e, i)))
            json_array_append_new(list, fix_of(d, e, i));
    return list;
}

static json_t *result_of(const struct diag *d, const struct diag_entry *e)
{
    json_t *locations = json_array(), *physical = physical_location(d, e->span);
    if (physical)
        json_array_append_new(locations, json_pack("{s:o}", "physicalLocation", physical));
    json_t *result = json_pack("{s:s, s:i, s:s, s:o, s:o}", "ruleId", diag_rules[e->code].code,
                               "ruleIndex", (int)e->code, "level", diag_level_name(e->level),
                               "message", message_of(e->message), "locations", locations);
    if (e->labels.n + e->notes.n > 0)
        json_object_set_new(result, "relatedLocations", related_of(d, e));
    if (e->frames.n > 0)
        json_object_set_new(result, "stacks", stacks_of(d, e));
    if (e->fixits.n > 0)
        json_object_set_new(result, "fixes", fixes_of(d, e));
    if (e->repeats > 0)
        json_object_set_new(result, "occurrenceCount", json_integer((json_int_t)e->repeats + 1));
    return result;
}

static void add_explanation(json_t *rule, enum diag_code code, const struct diag_book *book)
{
    const char *why = book ? book->why(code) : NULL;
    struct buffer text = {0};
    if (!why)
        return;
    book->explain(code, &text);
    buffer_add(&text, "", 1);
    json_object_set_new(rule, "fullDescription", message_of(why));
    json_object_set_new(rule, "help", message_of(text.at));
    buffer_free(&text);
}

static json_t *rules(const struct diag_book *book)
{
    json_t *list = json_array();
    for (int i = 0; i < DIAG_CODES; i++) {
        const struct diag_rule *r = &diag_rules[i];
        json_t *rule =
            json_pack("{s:s, s:s, s:o, s:{s:s, s:b}}", "id", r->code, "name", r->slug,
                      "shortDescription", message_of(r->summary), "defaultConfiguration", "level",
                      diag_level_name(r->level), "enabled", !diag_is_optional((enum diag_code)i));
        add_explanation(rule, (enum diag_code)i, book);
        json_array_append_new(list, rule);
    }
    return list;
}

static void put(json_t *value, FILE *out)
{
    if (!value || json_dumpf(value, out, JSON_INDENT(1)) != 0)
        fputs("{}", out);
    json_decref(value);
}

/* The log and its run are opened with the first file and closed behind the last. */
void diag_print_sarif(const struct diag *d, const struct diag_print_options *o, FILE *out)
{
    size_t printed = o->printed ? *o->printed : 0;
    if (!o->begun) {
        fputs("{\"$schema\": \"" SCHEMA "\",\n\"version\": \"2.1.0\",\n\"runs\": [\n{\"tool\": ",
              out);
        put(json_pack("{s:{s:s, s:s, s:o}}", "driver", "name", "wrt", "version", PACKAGE_VERSION,
                      "rules", rules(o->book)),
            out);
        fputs(",\n\"columnKind\": \"unicodeCodePoints\",\n\"results\": [\n", out);
    }
    for (size_t i = 0; i < d->entries.n; i++) {
        if (!diag_is_shown(d->entries.at[i], o->least))
            continue;
        fputs(printed++ ? ",\n" : "", out);
        put(result_of(d, d->entries.at[i]), out);
    }
    if (!o->goes_on)
        fputs("\n]}]}\n", out);
    if (o->printed)
        *o->printed = printed;
}
