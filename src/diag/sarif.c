/* Diagnostics as a SARIF 2.1.0 log (OASIS Standard, 2020): one run, its rules, its results. */
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

/* File names become references: what a URI does not hold is percent-encoded. */
static json_t *uri_of(const char *name)
{
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
    return json_pack("{s:o, s:[{s:{s:o}, s:o}]}", "description",
                     message_of(f->kind == DIAG_FIX_SAFE ? "safe" : "maybe"), "artifactChanges",
                     "artifactLocation", "uri", uri_of(source->name), "replacements", list);
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

static json_t *rules(void)
{
    json_t *list = json_array();
    for (int i = 0; i < DIAG_CODES; i++) {
        const struct diag_rule *r = &diag_rules[i];
        json_array_append_new(list,
                              json_pack("{s:s, s:s, s:o, s:{s:s, s:b}}", "id", r->code, "name",
                                        r->slug, "shortDescription", message_of(r->summary),
                                        "defaultConfiguration", "level", diag_level_name(r->level),
                                        "enabled", !diag_is_optional((enum diag_code)i)));
    }
    return list;
}

void diag_print_sarif(const struct diag *d, const struct diag_print_options *o, FILE *out)
{
    json_t *results = json_array();
    for (size_t i = 0; i < d->entries.n; i++)
        if (diag_is_shown(d->entries.at[i], o->least))
            json_array_append_new(results, result_of(d, d->entries.at[i]));
    json_t *run = json_pack("{s:{s:{s:s, s:s, s:o}}, s:s, s:o}", "tool", "driver", "name", "wrt",
                            "version", PACKAGE_VERSION, "rules", rules(), "columnKind",
                            "unicodeCodePoints", "results", results);
    if (!o->begun)
        fputs("{\"$schema\": \"" SCHEMA "\",\n\"version\": \"2.1.0\",\n\"runs\": [\n", out);
    if (!run || json_dumpf(run, out, JSON_INDENT(1)) != 0)
        fputs("{}", out);
    fputs(o->goes_on ? ",\n" : "\n]}\n", out);
    json_decref(run);
}
