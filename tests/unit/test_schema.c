/* The table of kinds and properties. */
#include "config.h"

#include "schema/schema.h"

#include "load.h"
#include "unit.h"

static const struct schema_prop *prop(int i)
{
    return &schema_props[i];
}

START_TEST(kind_names)
{
    const struct schema_kind_row *k = &schema_kinds[_i];
    const char *word = strchr(k->native, ' ');
    enum schema_kind kind = (enum schema_kind)_i;
    ck_assert_uint_gt(strlen(k->doc), 3);
    ck_assert_int_eq(schema_find_kind(k->group, str_of(word ? word + 1 : k->native), false), kind);
    ck_assert_int_eq(schema_find_kind(k->group, str_of(k->xml), true), kind);
    for (int other = 0; other < _i; other++)
        ck_assert_str_ne(schema_kinds[other].xml, k->xml);
}
END_TEST

/* Every name leads back to its property, whichever kind asks. */
START_TEST(property_names)
{
    enum schema_prop_id id = (enum schema_prop_id)_i;
    ck_assert_uint_gt(strlen(prop(_i)->doc), 5);
    ck_assert_uint_ne(prop(_i)->kinds, 0);
    for (int k = 0; k < SCHEMA_KINDS; k++) {
        enum schema_kind kind = (enum schema_kind)k;
        unsigned leaf;
        if (!schema_has(kind, id))
            continue;
        ck_assert_uint_eq(schema_leaf_count(id) > 0, *schema_kinds[k].xml != 0);
        ck_assert_uint_ne(prop(_i)->models & schema_kinds[k].models, 0);
        ck_assert_int_eq(schema_find_prop(kind, str_of(prop(_i)->native), false, &leaf), id);
        for (unsigned n = 0; n < schema_leaf_count(id); n++) {
            ck_assert_int_eq(schema_find_prop(kind, schema_leaf(id, n), true, &leaf), id);
            ck_assert_uint_eq(leaf, n);
        }
    }
}
END_TEST

START_TEST(property_values)
{
    const struct schema_prop *p = prop(_i);
    enum schema_prop_id id = (enum schema_prop_id)_i;
    ck_assert_msg(!(p->required & p->has_default), "%s is required and has a default", p->native);
    ck_assert_uint_ne(p->models, 0);
    ck_assert_int_eq(p->words != NULL, p->type == TYPE_WORD);
    ck_assert(p->most == 0 || p->most > p->least);
    for (int m = 0; m < SCHEMA_MODELS; m++)
        if (p->has_least && (p->has_default >> m & 1))
            ck_assert(p->above ? p->value[m][0] > p->least : p->value[m][0] >= p->least);
    if (schema_leaf_count(id) > 1)
        ck_assert(p->type == TYPE_POINTS || p->type == TYPE_SIZE);
    if (p->type == TYPE_FILE || p->type == TYPE_MATERIAL || p->type == TYPE_SURFACE ||
        p->type == TYPE_POINTS)
        ck_assert(!p->has_default && !p->has_least);
    for (int m = 0; m < SCHEMA_MODELS; m++)
        if (p->type == TYPE_WORD && (p->has_default >> m & 1))
            ck_assert_uint_gt(schema_word(id, (unsigned)p->value[m][0], false).n, 0);
}
END_TEST

START_TEST(property_words)
{
    enum schema_prop_id id = (enum schema_prop_id)_i;
    unsigned n = 0;
    if (prop(_i)->type != TYPE_WORD)
        return;
    for (; schema_word(id, n, false).n; n++) {
        ck_assert_int_eq(schema_find_word(id, schema_word(id, n, false), false), (int)n);
        ck_assert_int_eq(schema_find_word(id, schema_word(id, n, true), true), (int)n);
    }
    ck_assert_uint_ge(n, 2);
    ck_assert_int_eq(schema_find_word(id, str_of("no such word"), true), -1);
    ck_assert_int_eq(schema_find_word(id, str_of(""), false), -1);
}
END_TEST

START_TEST(names_of_groups_and_types)
{
    for (int g = 0; g < SCHEMA_GROUPS; g++)
        ck_assert_ptr_nonnull(schema_group_name((enum schema_group)g));
    for (int t = 0; t < SCHEMA_TYPES; t++)
        ck_assert_ptr_nonnull(schema_type_name((enum schema_type)t));
}
END_TEST

static const struct {
    enum schema_group group;
    enum schema_model model;
    const char *name, *found;
    bool xml;
} guesses[] = {
    {SCHEMA_SURFACE, SCHEMA_CLASSIC, "shpere", "sphere", false},
    {SCHEMA_SURFACE, SCHEMA_MODERN, "Sfere", "Sphere", true},
    {SCHEMA_LIGHT, SCHEMA_CLASSIC, "aera", "area", false},
    {SCHEMA_LIGHT, SCHEMA_CLASSIC, "sum", "", false},
    {SCHEMA_LIGHT, SCHEMA_MODERN, "sum", "sun", false},
    {SCHEMA_MATERIAL, SCHEMA_CLASSIC, "phnog", "phong", false},
    {SCHEMA_SURFACE, SCHEMA_MODERN, "teapot", "", false},
    {SCHEMA_MATERIAL, SCHEMA_CLASSIC, "lambret", "Lambert", true},
};

/* What is required or has a default differs between the models. */
START_TEST(models)
{
    ck_assert(schema_required(PROP_YFOV, SCHEMA_CLASSIC));
    ck_assert(!schema_required(PROP_YFOV, SCHEMA_MODERN));
    ck_assert(schema_required(PROP_UP, SCHEMA_CLASSIC) && !schema_required(PROP_UP, SCHEMA_MODERN));
    ck_assert(schema_required(PROP_EYE, SCHEMA_CLASSIC) &&
              schema_required(PROP_EYE, SCHEMA_MODERN));
    struct str near = schema_nearest_prop(KIND_CAMERA, SCHEMA_MODERN, str_of("fow"), false);
    ck_assert(str_is(near, "fov"));
    near = schema_nearest_prop(KIND_CAMERA, SCHEMA_CLASSIC, str_of("bakc"), false);
    ck_assert(str_is(near, "back"));
    near = schema_nearest_prop(KIND_CAMERA, SCHEMA_MODERN, str_of("bakc"), false);
    ck_assert(str_is(near, ""));
}
END_TEST

START_TEST(nearest_kind)
{
    struct str s = schema_nearest_kind(guesses[_i].group, guesses[_i].model,
                                       str_of(guesses[_i].name), guesses[_i].xml);
    ck_assert_msg(str_is(s, guesses[_i].found), "%.*s", STR_ARG(s));
}
END_TEST

Suite *schema_suite(void)
{
    Suite *s = suite_create("schema");
    TCase *t = tcase_create("table");
    tcase_add_loop_test(t, kind_names, 0, SCHEMA_KINDS);
    tcase_add_loop_test(t, property_names, 0, SCHEMA_PROPS);
    tcase_add_loop_test(t, property_values, 0, SCHEMA_PROPS);
    tcase_add_loop_test(t, property_words, 0, SCHEMA_PROPS);
    tcase_add_test(t, names_of_groups_and_types);
    tcase_add_test(t, models);
    tcase_add_loop_test(t, nearest_kind, 0, COUNT(guesses));
    suite_add_tcase(s, t);
    return s;
}
