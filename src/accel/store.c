#include "config.h"

#include "accel/store.h"

#include "base/vec.h"

/* Trees without prototypes, which are kept by themselves. */
struct accel_store {
    VEC(struct accel) kept;
};

struct accel_store *accel_store_new(void)
{
    return mem_zalloc(1, sizeof(struct accel_store));
}

static void drop_all(struct accel_store *s)
{
    for (size_t i = 0; i < s->kept.n; i++)
        accel_free(&s->kept.at[i]);
    s->kept.n = 0;
}

void accel_store_free(struct accel_store *s)
{
    drop_all(s);
    vec_free(&s->kept);
    free(s);
}

bool accel_store_take(struct accel_store *s, uint64_t fingerprint, struct accel *out)
{
    for (size_t i = 0; i < s->kept.n; i++) {
        if (s->kept.at[i].fingerprint != fingerprint)
            continue;
        *out = s->kept.at[i];
        s->kept.at[i] = s->kept.at[--s->kept.n];
        return true;
    }
    return false;
}

static void keep(struct accel_store *s, struct accel *a)
{
    size_t prototypes = a->prototypes ? a->geometry->prototypes.n : 0;
    for (size_t i = 0; i < prototypes; i++)
        if (a->prototypes[i].geometry)
            keep(s, &a->prototypes[i]);
    free(a->prototypes);
    a->prototypes = NULL;
    vec_push(&s->kept, *a);
    *a = (struct accel){0};
}

void accel_store_keep(struct accel_store *s, struct accel *a)
{
    drop_all(s);
    keep(s, a);
}
