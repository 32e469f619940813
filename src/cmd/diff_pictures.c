#include "config.h"

#include "cmd/diff.h"
#include "cmd/frontend.h"

#include "base/file.h"
#include "image/measures.h"

#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct comparing {
    const struct options *options;
    const struct diff_input *inputs;
    struct picture *pictures[2];
    float *flip; /* of each pixel */
    struct measures measures;
    struct frontend frontend; /* for what is found */
};

static void refuse(struct comparing *c, const char *why)
{
    diag_report(&c->frontend.diag, DIAG_NOT_COMPARABLE, (struct span){0}, "%s", why);
}

/* Both read and alike; false after reporting. */
static bool load(struct comparing *c)
{
    char why[IMAGE_REASON_BYTES];
    for (int i = 0; i < 2; i++) {
        const struct diff_input *in = &c->inputs[i];
        c->pictures[i] = picture_decode(in->bytes, in->n, why);
        if (!c->pictures[i])
            diag_report(&c->frontend.diag, DIAG_PICTURE_UNREADABLE, (struct span){0},
                        "could not read the picture '%s': %s", in->name, why);
    }
    const struct picture *a = c->pictures[0], *b = c->pictures[1];
    if (!a || !b)
        return false;
    snprintf(why, sizeof why,
             "pictures of %" PRIu32 " x %" PRIu32 " and %" PRIu32 " x %" PRIu32
             " pixels are not compared",
             a->width, a->height, b->width, b->height);
    if (a->width != b->width || a->height != b->height)
        refuse(c, why);
    else if (!a->floats != !b->floats)
        refuse(c, "a picture of floats, which hold light, is not compared with one of bytes");
    return c->frontend.diag.errors == 0;
}

/* ---- what is told ---- */

static bool above_limit(const struct comparing *c, int measure)
{
    const struct options *o = c->options;
    bool limited = o->limited ? !isnan(o->limits[measure]) : measure == MEASURE_MAX;
    return limited && c->measures.at[measure] > (o->limited ? o->limits[measure] : 0);
}

static bool any_above(const struct comparing *c)
{
    bool any = false;
    for (int i = 0; i < MEASURES; i++)
        any = any || above_limit(c, i);
    return any;
}

static void print_text(const struct comparing *c, FILE *out)
{
    static const char *const units[MEASURES] = {
        [MEASURE_PSNR] = " dB",
        [MEASURE_ABOVE] = " % of the pixels differ by more than 1/255",
    };
    const struct measures *m = &c->measures;
    for (int i = 0; i < MEASURES; i++) {
        fprintf(out, "%-6s %.6g%s", measure_names[i], m->at[i], units[i] ? units[i] : "");
        if (i == MEASURE_MAX && m->at[i] > 0)
            fprintf(out, " at %" PRIu32 ",%" PRIu32, m->x, m->y);
        if (c->options->limited && above_limit(c, i))
            fprintf(out, ", above the limit of %.6g", c->options->limits[i]);
        fputc('\n', out);
    }
}

/* Null stands for infinity, which JSON lacks. */
static json_t *number_json(double x)
{
    return isfinite(x) ? json_real(x) : json_null();
}

static void print_json(const struct comparing *c, FILE *out)
{
    const struct measures *m = &c->measures;
    size_t layout = c->options->format == DIAG_FORMAT_JSON ? JSON_COMPACT : JSON_INDENT(2);
    json_t *failed = json_array();
    json_t *j =
        json_pack("{s:s, s:s, s:i, s:i}", "a", c->inputs[0].name, "b", c->inputs[1].name, "width",
                  (int)c->pictures[0]->width, "height", (int)c->pictures[0]->height);
    for (int i = 0; i < MEASURES; i++) {
        json_object_set_new(j, measure_names[i], number_json(m->at[i]));
        if (above_limit(c, i))
            json_array_append_new(failed, json_string(measure_names[i]));
    }
    json_object_set_new(j, "at", json_pack("[i, i]", (int)m->x, (int)m->y));
    json_object_set_new(j, "failed", failed);
    if (j && json_dumpf(j, out, layout | JSON_REAL_PRECISION(9)) == 0)
        fputc('\n', out);
    json_decref(j);
}

/* Floats get the differences as they are, bytes what they look like. */
static void write_difference(struct comparing *c, enum picture_format format)
{
    const char *path = c->options->output;
    const struct picture *a = c->pictures[0];
    struct picture *p = format == PICTURE_PFM ? difference_floats(a, c->pictures[1])
                                              : difference_heat(c->flip, a->width, a->height);
    char why[IMAGE_REASON_BYTES];
    size_t n = 0;
    void *bytes = picture_encode(p, format, &n, why);
    const char *reason = bytes ? file_write(path, bytes, n) : why;
    if (reason)
        diag_report(&c->frontend.diag, DIAG_CANNOT_WRITE, (struct span){0},
                    "could not write '%s': %s", path, reason);
    free(bytes);
    picture_free(p);
}

static void compare(struct comparing *c, enum picture_format format)
{
    const struct options *o = c->options;
    const struct picture *a = c->pictures[0], *b = c->pictures[1];
    FILE *out = o->output && strcmp(o->output, "-") == 0 ? stderr : stdout;
    c->flip = mem_alloc((size_t)a->width * a->height, sizeof *c->flip);
    measure_pictures(a, b, o->threads, c->flip, &c->measures);
    if (o->output)
        write_difference(c, format);
    (o->json ? print_json : print_text)(c, out);
}

int diff_pictures(const struct diff_input inputs[2], const struct options *o)
{
    struct comparing c = {.options = o, .inputs = inputs};
    enum picture_format format = PICTURE_PNG;
    if (o->output && !picture_format_of(o->output, &format))
        return usage_error("--out: '%s' names no format; .png, .ppm and .pfm do", o->output);
    if (o->defines.n > 0 || o->folders.n > 0)
        return usage_error("--%s is for two scenes", o->defines.n > 0 ? "define" : "include");
    frontend_init(&c.frontend, o);
    bool loaded = load(&c);
    if (loaded)
        compare(&c, format);
    int status = frontend_report(&c.frontend, o, DIAG_WARNING);
    if (loaded && any_above(&c))
        status = status_worse(status, DIAG_EXIT_INPUT);
    free(c.flip);
    picture_free(c.pictures[0]);
    picture_free(c.pictures[1]);
    frontend_free(&c.frontend);
    return status;
}
