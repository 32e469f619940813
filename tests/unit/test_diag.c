/* Findings as text and in order. */
#include "config.h"

#include "diag/diag.h"

#include "load.h"
#include "unit.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

/* The findings as they are printed; the caller frees. */
static char *printed(struct load *l, enum diag_format format, enum diag_level least)
{
    char *text;
    size_t n;
    FILE *out = open_memstream(&text, &n);
    struct diag_print_options o = {.format = format, .least = least};
    diag_print(&l->diag, &o, out);
    fclose(out);
    return text;
}

static struct span span_in(const struct load *l, uint32_t begin, uint32_t end)
{
    return (struct span){l->source->base + begin, l->source->base + end};
}

#define X50 "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
#define HEAD(place) "it:" place ": error: text [E010-syntax]\n"

static const struct {
    const char *text;
    uint32_t begin, end;
    const char *fix, *expected;
} renderings[] = {
    {"abc def\n", 4, 7, NULL, HEAD("1:5") "    1 | abc def\n      |     ^~~\n"},
    {"abc def\n", 4, 4, NULL, HEAD("1:5") "    1 | abc def\n      |     ^\n"},
    {"abc", 3, 3, NULL, HEAD("1:4") "    1 | abc\n      |    ^\n"},
    {"abc\n", 4, 4, NULL, HEAD("2:1") "    2 | \n      | ^\n"},
    {"", 0, 0, NULL, HEAD("1:1") "    1 | \n      | ^\n"},
    {"abc\ndef", 1, 6, NULL, HEAD("1:2") "    1 | abc\n      |  ^~\n"}, /* to the line's end */
    {"\ta\tb\n", 3, 4, NULL, HEAD("1:4") "    1 |         a       b\n      |                 ^\n"},
    {"a\tb\n", 0, 3, NULL, HEAD("1:1") "    1 | a       b\n      | ^~~~~~~~~\n"},
    {"\xc3\xa9\xe2\x82\xac x", 6, 7, NULL,
     HEAD("1:4") "    1 | \xc3\xa9\xe2\x82\xac x\n      |    ^\n"},
    {"\xc3\xa9\xe2\x82\xac x", 0, 5, NULL,
     HEAD("1:1") "    1 | \xc3\xa9\xe2\x82\xac x\n      | ^~\n"},
    {"\x1b[1m\x07\xc2\x9b", 0, 1, NULL, HEAD("1:1") "    1 | ?[1m??\n      | ^\n"},
    {"a\x80\xff"
     "b",
     3, 4, NULL, HEAD("1:3") "    1 | a??b\n      |    ^\n"},
    {"crlf\r\nb", 2, 4, NULL, HEAD("1:3") "    1 | crlf\n      |   ^~\n"},
    {"abc def\n", 4, 7, "ghi", HEAD("1:5") "    1 | abc def\n      |     ^~~\n      |     ghi\n"},
    {"abc\n", 0, 0, "one\ntwo", HEAD("1:1") "    1 | abc\n      | ^\n      | one\n"},
    {X50 X50 X50 " y " X50 X50, 151, 152, "z",
     HEAD("1:152") "    1 | ..." X50 "xxxxxxxxx y xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx...\n"
                   "      |                                                                ^\n"
                   "      |                                                                z\n"},
};

START_TEST(text_of_finding)
{
    struct load l;
    load_text(&l, "it", renderings[_i].text);
    struct span span = span_in(&l, renderings[_i].begin, renderings[_i].end);
    struct diag_entry *e = diag_report(&l.diag, DIAG_SYNTAX, span, "text");
    if (renderings[_i].fix)
        diag_fix(e, span, DIAG_FIX_SAFE, "%s", renderings[_i].fix);
    char *text = printed(&l, DIAG_FORMAT_TEXT, DIAG_NOTE);
    ck_assert_str_eq(text, renderings[_i].expected);
    free(text);
    load_free(&l);
}
END_TEST

START_TEST(labels_notes_and_order)
{
    struct load l;
    load_text(&l, "it", "one\ntwo\nthree\n");
    struct diag_entry *e = diag_report(&l.diag, DIAG_SYNTAX, span_in(&l, 8, 13), "last");
    diag_label(e, span_in(&l, 0, 3), "first %s", "here");
    diag_note(e, "a note");
    diag_report(&l.diag, DIAG_SYNTAX, span_in(&l, 4, 7), "second of two");
    diag_report(&l.diag, DIAG_SYNTAX, span_in(&l, 4, 5), "third of two");
    diag_report(&l.diag, DIAG_MISSING_VERSION, span_in(&l, 0, 0), "a warning");
    diag_report(&l.diag, DIAG_CANNOT_WRITE, (struct span){0}, "no place");
    ck_assert_uint_eq(l.diag.errors, 4);
    ck_assert_uint_eq(l.diag.warnings, 1);
    ck_assert_int_eq(l.diag.exit, DIAG_EXIT_INPUT);
    char *text = printed(&l, DIAG_FORMAT_TEXT, DIAG_ERROR);
    ck_assert_str_eq(text, "wrt: error: no place [E301-cannot-write]\n"
                           "it:2:1: error: second of two [E010-syntax]\n"
                           "    2 | two\n      | ^~~\n"
                           "it:2:1: error: third of two [E010-syntax]\n"
                           "    2 | two\n      | ^\n"
                           "it:3:1: error: last [E010-syntax]\n"
                           "    3 | three\n      | ^~~~~\n"
                           "it:1:1: note: first here\n"
                           "    1 | one\n      | ^~~\n"
                           "note: a note\n");
    free(text);
    load_free(&l);
}
END_TEST

START_TEST(frames_in_words)
{
    struct load l;
    load_text(&l, "it", "chair\nring\n\"a.wrt\" i\n");
    const struct diag_frame include = {NULL, span_in(&l, 11, 18), DIAG_FRAME_INCLUDE, 0};
    const struct diag_frame use = {&include, span_in(&l, 0, 5), DIAG_FRAME_USE, 0};
    struct diag_frame round = {&use, span_in(&l, 19, 20), DIAG_FRAME_ROUND, 0.5};
    const struct diag_frame item = {&round, span_in(&l, 19, 20), DIAG_FRAME_ITEM, 7};
    const struct diag_frame call = {&item, span_in(&l, 6, 10), DIAG_FRAME_CALL, 0};
    const struct diag_frame again = {&call, span_in(&l, 6, 10), DIAG_FRAME_CALL, 0};
    l.diag.frame = &call;
    for (int i = 0; i < 3; i++, round.number++) /* one finding, then two repeats */
        diag_note(diag_report(&l.diag, DIAG_SYNTAX, span_in(&l, 0, 1), "m %d", i), "n");
    l.diag.frame = &again;
    ck_assert_ptr_eq(diag_report(&l.diag, DIAG_SYNTAX, span_in(&l, 0, 1), "m"), &l.diag.spare);
    l.diag.frame = NULL;
    ck_assert_uint_eq(l.diag.errors, 4);
    diag_report(&l.diag, DIAG_SYNTAX, span_in(&l, 0, 1), "straight");
    char *text = printed(&l, DIAG_FORMAT_TEXT, DIAG_ERROR);
    ck_assert_str_eq(text, "it:1:1: error: m 0 [E010-syntax]\n"
                           "    1 | chair\n      | ^\n"
                           "note: n\n"
                           "note: in ring(...) called at it:2:1\n"
                           "note: in 'for' with item 7 as i at it:3:9\n"
                           "note: in 'for' with i = 0.5 at it:3:9\n"
                           "note: in chair(...) used at it:1:1\n"
                           "note: in \"a.wrt\" included at it:3:1\n"
                           "note: the same was found 3 more times\n"
                           "it:1:1: error: straight [E010-syntax]\n"
                           "    1 | chair\n      | ^\n");
    free(text);
    load_free(&l);
}
END_TEST

START_TEST(ways_to_one_place_are_told_apart)
{
    struct load l;
    load_text(&l, "it", "a b");
    const struct diag_frame a = {NULL, span_in(&l, 0, 1), DIAG_FRAME_CALL, 0};
    const struct diag_frame b = {NULL, span_in(&l, 2, 3), DIAG_FRAME_CALL, 0};
    l.diag.frame = &a;
    diag_report(&l.diag, DIAG_SYNTAX, span_in(&l, 1, 2), "m");
    l.diag.frame = &b;
    diag_report(&l.diag, DIAG_SYNTAX, span_in(&l, 1, 2), "m");
    diag_report(&l.diag, DIAG_SYNTAX, span_in(&l, 1, 3), "m");
    diag_report(&l.diag, DIAG_TOO_DEEP, span_in(&l, 1, 3), "m");
    ck_assert_uint_eq(l.diag.entries.n, 4);
    load_free(&l);
}
END_TEST

START_TEST(deep_frames_are_cut)
{
    struct load l;
    struct diag_frame frames[300];
    load_text(&l, "it", "f");
    for (int i = 0; i < 300; i++) {
        frames[i] = (struct diag_frame){NULL, span_in(&l, 0, 1), DIAG_FRAME_CALL, 0};
        frames[i].parent = i ? &frames[i - 1] : NULL;
    }
    l.diag.frame = &frames[5];
    ck_assert_uint_eq(diag_report(&l.diag, DIAG_SYNTAX, span_in(&l, 0, 1), "m")->frames.n, 6);
    l.diag.frame = &frames[299];
    struct diag_entry *e = diag_report(&l.diag, DIAG_TOO_DEEP, span_in(&l, 0, 1), "m");
    ck_assert_uint_eq(e->frames.n, 6);
    ck_assert_str_eq(e->frames.at[3].text, "... 295 more ...");
    ck_assert_str_eq(e->frames.at[5].text, "in f(...) called");
    load_free(&l);
}
END_TEST

START_TEST(messages_are_tame)
{
    static char name[5000];
    struct load l;
    memset(name, 'n', sizeof name - 1);
    load_text(&l, "it", "");
    const char *m = diag_report(&l.diag, DIAG_SYNTAX, (struct span){0}, "'%s' end", name)->message;
    ck_assert_uint_lt(strlen(m), 700);
    ck_assert_ptr_nonnull(strstr(m, "..."));
    ck_assert_str_eq(m + strlen(m) - 5, "' end");
    m = diag_report(&l.diag, DIAG_SYNTAX, (struct span){0}, "%s", "\x1b]0;\x7f\xc2\x85\xc3\xa9\n")
            ->message;
    ck_assert_str_eq(m, "?]0;???\xc3\xa9?");
    for (size_t i = 0; i + 2 < sizeof name; i += 2)
        memcpy(name + i, "\xc3\xa9", 2);
    for (int skip = 0; skip < 2; skip++) { /* cut between characters */
        m = diag_report(&l.diag, DIAG_SYNTAX, (struct span){0}, "%s%s", skip ? "x" : "", name)
                ->message;
        ck_assert_uint_eq(str_utf8_valid(m, strlen(m) - 1), strlen(m) - 1);
    }
    load_free(&l);
}
END_TEST

START_TEST(findings_beyond_the_limit)
{
    struct load l;
    load_text(&l, "it", "abc");
    for (int i = 0; i < DIAG_LIMIT + 500; i++) {
        struct diag_entry *e = diag_report(&l.diag, DIAG_SYNTAX, span_in(&l, 0, 1), "%d", i);
        diag_label(e, span_in(&l, 0, 1), "label");
        diag_note(e, "note");
        diag_fix(e, span_in(&l, 0, 1), DIAG_FIX_SAFE, "fix");
    }
    ck_assert_uint_eq(l.diag.entries.n, DIAG_LIMIT);
    ck_assert_uint_eq(l.diag.errors, DIAG_LIMIT + 500);
    load_free(&l);
}
END_TEST

START_TEST(exit_statuses)
{
    struct load l;
    load_text(&l, "it", "");
    ck_assert_int_eq(l.diag.exit, DIAG_EXIT_OK);
    diag_report(&l.diag, DIAG_MISSING_VERSION, (struct span){0}, "w");
    ck_assert_int_eq(l.diag.exit, DIAG_EXIT_OK);
    diag_report(&l.diag, DIAG_FILE_MISSING, (struct span){0}, "r");
    ck_assert_int_eq(l.diag.exit, DIAG_EXIT_RESOURCE);
    diag_report(&l.diag, DIAG_SYNTAX, (struct span){0}, "i");
    diag_report(&l.diag, DIAG_FILE_MISSING, (struct span){0}, "r");
    ck_assert_int_eq(l.diag.exit, DIAG_EXIT_INPUT);
    load_free(&l);
}
END_TEST

/* Codes are unique and say by their first letter and digit what they are. */
START_TEST(rules)
{
    const struct diag_rule *r = &diag_rules[_i];
    ck_assert_int_eq(r->code[0], "NWE"[r->level]);
    ck_assert_uint_eq(strlen(r->code), 4);
    ck_assert(r->level != DIAG_ERROR || r->exit != DIAG_EXIT_OK);
    ck_assert_uint_eq(strspn(r->slug, "abcdefghijklmnopqrstuvwxyz-"), strlen(r->slug));
    ck_assert_uint_gt(strlen(r->summary), 10);
    for (int i = 0; i < _i; i++) {
        ck_assert_str_ne(diag_rules[i].code, r->code);
        ck_assert_str_ne(diag_rules[i].slug, r->slug);
    }
}
END_TEST

/* ---- SARIF: what the schema of 2.1.0 requires ---- */

static json_t *at(json_t *j, const char *key)
{
    json_t *found =
        json_is_array(j) ? json_array_get(j, strtoul(key, NULL, 10)) : json_object_get(j, key);
    ck_assert_msg(found != NULL, "no '%s'", key);
    return found;
}

static const char *text_at(json_t *j, const char *key)
{
    const char *text = json_string_value(at(j, key));
    ck_assert_ptr_nonnull(text);
    return text;
}

static void check_message(json_t *owner, const char *key)
{
    ck_assert_uint_gt(strlen(text_at(at(owner, key), "text")), 0);
}

static void check_region(json_t *region)
{
    json_int_t line = json_integer_value(at(region, "startLine"));
    json_int_t end_line = json_integer_value(at(region, "endLine"));
    json_int_t column = json_integer_value(at(region, "startColumn"));
    json_int_t end_column = json_integer_value(at(region, "endColumn"));
    ck_assert_int_ge(line, 1);
    ck_assert_int_ge(column, 1);
    ck_assert_int_ge(end_line, line);
    ck_assert(end_line > line || end_column >= column);
}

static void check_location(json_t *location)
{
    json_t *physical = json_object_get(location, "physicalLocation");
    ck_assert(physical || json_object_get(location, "message"));
    if (!physical)
        return;
    const char *uri = text_at(at(physical, "artifactLocation"), "uri");
    ck_assert_uint_eq(strcspn(uri, " \\\"<>"), strlen(uri));
    check_region(at(physical, "region"));
}

/* Every change lies in a file and replaces places that do not meet. */
static void check_fix(json_t *fix)
{
    json_t *change, *replacement;
    size_t i, k;
    check_message(fix, "description");
    ck_assert_uint_ge(json_array_size(at(fix, "artifactChanges")), 1);
    json_array_foreach(at(fix, "artifactChanges"), i, change)
    {
        json_int_t last = -1;
        text_at(at(change, "artifactLocation"), "uri");
        json_array_foreach(at(change, "replacements"), k, replacement)
        {
            json_t *region = at(replacement, "deletedRegion");
            check_region(region);
            text_at(at(replacement, "insertedContent"), "text");
            ck_assert_int_gt(json_integer_value(at(region, "byteOffset")), last);
            last = json_integer_value(at(region, "byteOffset"));
        }
    }
}

static void check_result(json_t *result, json_t *known)
{
    json_t *item;
    size_t i;
    const char *level = text_at(result, "level");
    json_t *rule = json_array_get(known, (size_t)json_integer_value(at(result, "ruleIndex")));
    ck_assert_str_eq(text_at(rule, "id"), text_at(result, "ruleId"));
    ck_assert(!strcmp(level, "error") || !strcmp(level, "warning") || !strcmp(level, "note"));
    check_message(result, "message");
    json_array_foreach(at(result, "locations"), i, item) check_location(item);
    json_array_foreach(json_object_get(result, "relatedLocations"), i, item) check_location(item);
    json_array_foreach(json_object_get(result, "fixes"), i, item) check_fix(item);
    json_array_foreach(json_object_get(result, "stacks"), i, item)
        check_location(at(at(at(item, "frames"), "0"), "location"));
}

/* One finding of each sort: with labels, notes, a stack, changes of two places, alternatives, and
 * without a place. */
static void report_all_sorts(struct load *l)
{
    const struct diag_frame frame = {NULL, span_in(l, 0, 3), DIAG_FRAME_USE, 0};
    struct diag_entry *e = diag_report(&l->diag, DIAG_SYNTAX, span_in(l, 4, 7), "one");
    diag_label(e, span_in(l, 0, 3), "label");
    diag_note(e, "note");
    diag_fix(e, span_in(l, 0, 3), DIAG_FIX_SAFE, "a");
    diag_fix(e, span_in(l, 8, 8), DIAG_FIX_SAFE, "b");
    e = diag_report(&l->diag, DIAG_WRONG_TYPE, span_in(l, 4, 13), "two");
    diag_fix(e, span_in(l, 4, 7), DIAG_FIX_MAYBE, "deg");
    diag_fix(e, span_in(l, 4, 7), DIAG_FIX_MAYBE, "rad");
    l->diag.frame = &frame;
    diag_report(&l->diag, DIAG_MISSING_VERSION, span_in(l, 0, 0), "three");
    diag_report(&l->diag, DIAG_MISSING_VERSION, span_in(l, 0, 0), "three");
    l->diag.frame = NULL;
    diag_report(&l->diag, DIAG_CANNOT_WRITE, (struct span){0}, "four");
}

START_TEST(sarif_has_what_is_required)
{
    struct load l;
    json_error_t error;
    load_text(&l, "a b.wrt", "one\ntwo\nthree\n");
    report_all_sorts(&l);
    char *text = printed(&l, DIAG_FORMAT_SARIF, DIAG_NOTE);
    json_t *log = json_loads(text, JSON_REJECT_DUPLICATES, &error), *result;
    ck_assert_msg(log != NULL, "%s", error.text);
    ck_assert_str_eq(text_at(log, "version"), "2.1.0");
    ck_assert_ptr_nonnull(strstr(text_at(log, "$schema"), "sarif-schema-2.1.0.json"));
    ck_assert_uint_eq(json_array_size(at(log, "runs")), 1);
    json_t *run = at(at(log, "runs"), "0"), *driver = at(at(run, "tool"), "driver");
    ck_assert_str_eq(text_at(driver, "name"), "wrt");
    json_t *known = at(driver, "rules"), *results = at(run, "results");
    ck_assert_uint_eq(json_array_size(known), DIAG_CODES);
    ck_assert_uint_eq(json_array_size(results), 4);
    size_t i;
    json_array_foreach(results, i, result) check_result(result, known);
    json_t *together = at(at(results, "2"), "fixes"), *either = at(at(results, "3"), "fixes");
    ck_assert_uint_eq(json_array_size(together), 1);
    json_t *change = at(at(at(together, "0"), "artifactChanges"), "0");
    ck_assert_uint_eq(json_array_size(at(change, "replacements")), 2);
    ck_assert_uint_eq(json_array_size(either), 2);
    ck_assert_str_eq(text_at(at(change, "artifactLocation"), "uri"), "a%20b.wrt");
    ck_assert_int_eq(json_integer_value(at(at(results, "1"), "occurrenceCount")), 2);
    json_decref(log);
    free(text);
    load_free(&l);
}
END_TEST

Suite *diag_suite(void)
{
    Suite *s = suite_create("diag");
    TCase *t = tcase_create("text");
    tcase_add_loop_test(t, text_of_finding, 0, COUNT(renderings));
    tcase_add_test(t, labels_notes_and_order);
    tcase_add_test(t, frames_in_words);
    tcase_add_test(t, ways_to_one_place_are_told_apart);
    tcase_add_test(t, deep_frames_are_cut);
    tcase_add_test(t, messages_are_tame);
    suite_add_tcase(s, t);

    t = tcase_create("SARIF");
    tcase_add_test(t, sarif_has_what_is_required);
    suite_add_tcase(s, t);

    t = tcase_create("findings");
    tcase_add_test(t, findings_beyond_the_limit);
    tcase_add_test(t, exit_statuses);
    tcase_add_loop_test(t, rules, 0, DIAG_CODES);
    suite_add_tcase(s, t);
    return s;
}
