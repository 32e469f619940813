/* Files that scenes name. */
#include "config.h"

#include "fuzz.h"

#include "convert/uv.h"
#include "farm/tilefile.h"
#include "image/picture.h"
#include "scene/mesh.h"
#include "scene/openmesh.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

struct file_run {
    struct srcmap sources;
    struct diag diag;
    const struct source *source;
};

static void begin(struct file_run *r, const uint8_t *data, size_t n)
{
    *r = (struct file_run){0};
    diag_init(&r->diag, &r->sources);
    r->source = srcmap_add(&r->sources, "file", fuzz_copy(data, n), n);
}

static void end(struct file_run *r)
{
    diag_free(&r->diag);
    srcmap_free(&r->sources);
}

/* Corners are vertices, normals are there or not, and the analysis takes it as well. */
static void use(struct mesh *m)
{
    for (size_t i = 0; i < m->faces.n; i++)
        for (int k = 0; k < 3; k++)
            if (m->faces.at[i].at[k] >= m->points.n)
                abort();
#ifdef HAVE_OPENMESH
    struct mesh_report report;
    openmesh_analyse(m->points.at, m->points.n, m->faces.at, m->faces.n, &report);
#endif
}

void fuzz_mesh(const uint8_t *data, size_t n)
{
    struct file_run r;
    begin(&r, data, n);
    struct mesh *m = mesh_parse(r.source, &r.diag);
    if (m)
        use(m);
    mesh_free(m);
    end(&r);
}

/* The first byte is the number of faces. */
void fuzz_uv_list(const uint8_t *data, size_t n)
{
    struct file_run r;
    struct vec2 *uvs = NULL;
    begin(&r, n ? data + 1 : data, n ? n - 1 : 0);
    if (uv_list_parse(r.source, n ? data[0] : 0, &uvs, &r.diag))
        free(uvs);
    end(&r);
}

void fuzz_wrl(const uint8_t *data, size_t n)
{
    struct file_run r;
    struct buffer out = {0};
    begin(&r, data, n);
    uv_list_from_vrml(r.source, &out, &r.diag);
    buffer_free(&out);
    end(&r);
}

void fuzz_texture(const uint8_t *data, size_t n)
{
    char reason[IMAGE_REASON_BYTES];
    image_free(image_decode(data, n, reason));
    picture_free(picture_decode(data, n, reason));
}

/* As `wrt merge` reads a part. */
static void read_tiles(const char *path)
{
    struct tilefile t;
    bool torn;
    size_t first, n;
    if (tilefile_open(&t, path, &torn))
        return;
    struct picture *p = picture_new(t.head.width, t.head.height, t.head.depth);
    while (tilefile_next(&t, p, &first, &n) == TILEFILE_TILES)
        if (n == 0 || first + n > t.tiling.n)
            abort();
    picture_free(p);
    tilefile_close(&t);
}

/* A file of tiles, or, behind a first byte of 0, one record of a picture without its check, which
 * no fuzzer guesses. */
void fuzz_tiles(const uint8_t *data, size_t n)
{
    enum { SIDE = 40 };
    const struct tilefile_head head = {.width = SIDE, .height = SIDE, .depth = PICTURE_BYTES};
    if (n && data[0] == 0) {
        struct tiling tiling = tilefile_tiling(&head);
        struct picture *p = picture_new(SIDE, SIDE, PICTURE_BYTES);
        size_t first, tiles;
        tilefile_take_tiles(&tiling, (const char *)data + 1, n - 1, p, &first, &tiles);
        picture_free(p);
        return;
    }
    char path[64];
    int file = memfd_create("tiles", MFD_CLOEXEC);
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    if (file < 0 || write(file, data, n) != (ssize_t)n)
        exit(3);
    read_tiles(path);
    close(file);
}
