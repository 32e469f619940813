#include "config.h"

#include "reading.h"

#include "base/mem.h"

#include <check.h>
#include <string.h>

/* Something stands before the text, so that offsets of the map and of the text differ. */
void reading_init(struct reading *r, const char *name, const void *text, size_t n)
{
    *r = (struct reading){0};
    srcmap_add(&r->map, "before", mem_zalloc(10 + 2, 1), 10);
    char *copy = mem_alloc(n + 2, 1);
    memcpy(copy, text, n);
    r->source = srcmap_add(&r->map, name, copy, n);
    diag_init(&r->diag, &r->map);
}

void reading_free(struct reading *r)
{
    diag_free(&r->diag);
    srcmap_free(&r->map);
}

void check_error(const struct reading *r, enum diag_code code, const char *place,
                 const char *message)
{
    ck_assert_uint_eq(r->diag.entries.n, 1);
    const struct diag_entry *e = r->diag.entries.at[0];
    ck_assert_msg(e->code == code, "%s: %s", diag_rules[e->code].slug, e->message);
    ck_assert_msg(strstr(e->message, message), "'%s' is not in '%s'", message, e->message);
    ck_assert_uint_ge(e->span.begin, r->source->base);
    ck_assert_uint_le(e->span.end, r->source->base + r->source->n);
    struct str at = srcmap_text(&r->map, e->span);
    ck_assert_msg(str_is(at, place), "'%s' stands at '%.*s', not '%s'", e->message, STR_ARG(at),
                  place);
}

void blob_put(struct blob *b, uint64_t bits, int size)
{
    for (int i = 0; i < size; i++)
        vec_push(&b->bytes, (char)(bits >> 8 * (b->big_endian ? size - 1 - i : i)));
}

void blob_float(struct blob *b, float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    blob_put(b, bits, 4);
}

void blob_double(struct blob *b, double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    blob_put(b, bits, 8);
}

void blob_text(struct blob *b, const char *text)
{
    for (; *text; text++)
        vec_push(&b->bytes, *text);
}
