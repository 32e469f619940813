/* One tile's pixels, each cut into cells while its error is too large. */
#include "config.h"

#include "render/frame.h"

/* A pixel under way. */
struct task {
    struct cubature *cells;
    uint32_t x, y; /* of the crop */
};

/* A sample on the border of two pixels, which one of them has traced. */
struct copy {
    struct vec3 *to;
    const struct vec3 *from;
};

struct refiner {
    struct cubature *cells[BATCH]; /* made when first needed */
    struct task active[BATCH];
    uint32_t n;
    uint32_t most; /* samples of a pixel */
    struct tile tile;
    struct cubature *at[TILE][TILE]; /* of the tile's pixels; NULL: not under way */
    /* Samples to be traced together: */
    struct vec3 *to[BATCH];
    double x[BATCH_ROOM], y[BATCH_ROOM];
    uint32_t queued;
    VEC(struct copy) copies; /* to be done when all are traced */
};

void refiner_free(struct refiner *r)
{
    if (!r)
        return;
    for (unsigned i = 0; i < BATCH; i++)
        free(r->cells[i]);
    vec_free(&r->copies);
    free(r);
}

/* ---- errors and colours as the picture has them ---------------------------------------------- */

/* Half the way from a standard error below the mean to one above; 0 where a sample is not a number,
 * which more of them would not change. */
static double stored_channel(const struct frame *f, double mean, double variance)
{
    double gain = f->out->gain, error = variance > 0 ? gain * sqrt(variance) : 0;
    if (f->out->floats)
        return error;
    enum picture_encoding e = f->encoding;
    return 0.5 *
           (picture_channel(e, gain * mean + error) - picture_channel(e, gain * mean - error));
}

struct vec3 stored_errors(const struct frame *f, const struct estimate *e)
{
    return vec3(stored_channel(f, e->mean.x, e->variance.x),
                stored_channel(f, e->mean.y, e->variance.y),
                stored_channel(f, e->mean.z, e->variance.z));
}

double stored_error(const struct frame *f, const struct estimate *e)
{
    struct vec3 errors = stored_errors(f, e);
    return fmax(errors.x, fmax(errors.y, errors.z));
}

/* How many samples a pixel took, by the logarithm: from 5, dark blue, over cyan, yellow and red to
 * the most, white; as floats the number itself. */
static struct vec3 heat(uint32_t samples, bool bytes)
{
    enum { FEWEST = CUBATURE_FIRST, STEPS = 4 };
    static const struct vec3 colour[STEPS + 1] = {
        {0, 0, 0.4}, {0, 0.7, 0.9}, {1, 0.9, 0}, {0.9, 0, 0}, {1, 1, 1}};
    if (!bytes)
        return vec3_all(samples);
    if (samples < FEWEST)
        return vec3_all(0);
    double t = STEPS * log((double)samples / FEWEST) / log((double)CUBATURE_SAMPLES / FEWEST);
    int i = t < STEPS - 1 ? (int)t : STEPS - 1;
    return vec3_mad(colour[i], t - i, vec3_sub(colour[i + 1], colour[i]));
}

static void set_pixel(struct frame *f, uint32_t x, uint32_t y, struct vec3 mean, uint32_t samples)
{
    bool counts = f->tracer->options->show == SHOW_SAMPLES;
    picture_set(f->out, x - f->crop.x0, y - f->crop.y0,
                counts ? heat(samples, !f->out->floats) : mean);
}

/* ---- one pixel ------------------------------------------------------------------------------- */

/* By how much the picture stretches errors of a channel, squared. */
static double stretch(double stored, double variance)
{
    return variance > 0 ? stored * stored / variance : 0;
}

/* Wants the samples that all pixels under way have at least, and then more for the worst of it
 * while its error is too large; false when it is done. */
static bool cut(const struct frame *f, struct cubature *c)
{
    uint32_t grid = f->tracer->options->grid;
    if (c->cells < grid * grid) {
        cubature_cut_all(c);
        return true;
    }
    if (c->samples == CUBATURE_FIRST) {
        cubature_quarter_all(c);
        return true;
    }
    if (!(stored_error(f, &c->whole) > f->target))
        return false;
    struct vec3 e = stored_errors(f, &c->whole), v = c->whole.variance;
    return cubature_refine(c, vec3(stretch(e.x, v.x), stretch(e.y, v.y), stretch(e.z, v.z)));
}

static void start_pixel(const struct frame *f, const struct first *first, struct cubature *c)
{
    cubature_begin(c, f->tracer->options->jitter);
    memcpy(c->value, first->sample, sizeof first->sample);
    cubature_settle(c);
}

/* A pixel that is given up before it is done may have been better before. */
static void finish_pixel(struct frame *f, struct refiner *r, const struct task *task, bool done)
{
    const struct cubature *c = task->cells;
    size_t pixel = frame_pixel(f, task->x, task->y);
    double found = stored_error(f, &c->whole);
    if (!done && f->refined[pixel] && found > f->error[pixel])
        return;
    f->error[pixel] = (float)found;
    f->refined[pixel] = true;
    set_pixel(f, task->x, task->y, c->whole.mean, c->samples);
    r->most = c->samples > r->most ? c->samples : r->most;
}

/* How wrong a pixel may be: its error, or, while it has nothing but its first samples, that of the
 * pixels around it, whose edges and small things may reach into it unseen. */
static double doubt(const struct frame *f, uint32_t x, uint32_t y)
{
    size_t pixel = frame_pixel(f, x, y);
    double squares = 0, n = 0;
    if (f->refined[pixel])
        return f->error[pixel];
    for (uint32_t j = y > 0 ? y - 1 : 0; j <= y + 1 && j < f->height; j++) {
        for (uint32_t i = x > 0 ? x - 1 : 0; i <= x + 1 && i < f->width; i++, n++) {
            double error = f->first_error[frame_pixel(f, i, j)];
            squares += error * error;
        }
    }
    return fmax(f->first_error[pixel], sqrt(squares / n));
}

/* The picture that the first samples give; false where they are not all known. */
static bool begin_pixel(struct frame *f, struct refiner *r, uint32_t x, uint32_t y)
{
    size_t pixel = frame_pixel(f, x, y);
    struct first first;
    if (f->error[pixel] < INFINITY)
        return true;
    f->error[pixel] = f->first_error[pixel];
    if (!first_of_pixel(f, x, y, &first)) {
        set_pixel(f, x, y, first_nearby(f, x, y), 1);
        r->most = r->most > 1 ? r->most : 1;
        return false;
    }
    struct estimate e = first_estimate(f, &first);
    set_pixel(f, x, y, e.mean, CUBATURE_FIRST);
    r->most = r->most > CUBATURE_FIRST ? r->most : CUBATURE_FIRST;
    return true;
}

/* Makes a pixel a task if it needs more samples. */
static void take_pixel(struct frame *f, struct refiner *r, uint32_t x, uint32_t y)
{
    bool all = f->tracer->options->grid > 1 && !f->refined[frame_pixel(f, x, y)];
    if (!begin_pixel(f, r, x, y) || f->target == INFINITY || (!all && doubt(f, x, y) <= f->target))
        return;
    struct first first;
    first_of_pixel(f, x, y, &first);
    if (!r->cells[r->n])
        r->cells[r->n] = mem_alloc(1, sizeof **r->cells);
    start_pixel(f, &first, r->cells[r->n]);
    r->active[r->n] = (struct task){r->cells[r->n], x, y};
    r->at[y - r->tile.y0][x - r->tile.x0] = r->cells[r->n];
    r->n++;
}

/* ---- the pixels of a tile -------------------------------------------------------------------- */

static void trace_queued(struct frame *f, struct refiner *r, unsigned worker)
{
    if (r->queued == 0)
        return;
    frame_trace(f, worker, r->x, r->y, r->queued);
    for (uint32_t i = 0; i < r->queued; i++)
        *r->to[i] = vec3_get(&f->workers[worker]->colours, i);
    r->queued = 0;
}

/* The sample that a neighbour within the tile has at this place of the pixel's border, or NULL. */
static const struct vec3 *shared_sample(const struct refiner *r, const struct task *task,
                                        struct cubature_place place)
{
    uint32_t x = task->x - r->tile.x0, y = task->y - r->tile.y0;
    if (place.x == 0 || place.x == CUBATURE_PLACES) {
        x += place.x == 0 ? UINT32_MAX : 1;
        place.x = CUBATURE_PLACES - place.x;
    } else if (place.y == 0 || place.y == CUBATURE_PLACES) {
        y += place.y == 0 ? 1 : UINT32_MAX;
        place.y = CUBATURE_PLACES - place.y;
    } else {
        return NULL;
    }
    if (x >= TILE || y >= TILE || !r->at[y][x] || !r->at[y][x]->number[place.y][place.x])
        return NULL;
    return &r->at[y][x]->value[r->at[y][x]->number[place.y][place.x] - 1];
}

/* Puts all that is wanted of the pixel into the queue, but what a neighbour has. */
static void queue_wanted(struct frame *f, struct refiner *r, const struct task *task,
                         unsigned worker)
{
    struct cubature *c = task->cells;
    for (uint32_t k = c->settled; k < c->samples; k++) {
        const struct vec3 *shared = shared_sample(r, task, c->place[k]);
        if (shared) {
            vec_push(&r->copies, (struct copy){&c->value[k], shared});
            continue;
        }
        uint32_t i = r->queued++;
        r->x[i] = task->x + (double)c->place[k].x / CUBATURE_PLACES;
        r->y[i] = task->y + 1 - (double)c->place[k].y / CUBATURE_PLACES;
        r->to[i] = &c->value[k];
        if (r->queued == BATCH)
            trace_queued(f, r, worker);
    }
}

/* One more round of cuts; pixels that need none are done. */
static void cut_active(struct frame *f, struct refiner *r, unsigned worker)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < r->n; i++) {
        struct task task = r->active[i];
        if (cut(f, task.cells)) {
            queue_wanted(f, r, &task, worker);
            r->active[left++] = task;
        } else {
            finish_pixel(f, r, &task, true);
        }
    }
    trace_queued(f, r, worker);
    for (size_t i = 0; i < r->copies.n; i++)
        *r->copies.at[i].to = *r->copies.at[i].from;
    r->copies.n = 0;
    r->n = left;
    for (uint32_t i = 0; i < left; i++)
        cubature_settle(r->active[i].cells);
}

/* last: there is no time for more, and nobody asks for doubts. */
static struct tally tally_of(const struct frame *f, const struct tile *tile, bool last)
{
    struct tally tally = {.pixels = (uint32_t)tile_pixels(tile)};
    for (uint32_t y = tile->y0; y < tile->y1; y++) {
        for (uint32_t x = tile->x0; x < tile->x1; x++) {
            double error = f->error[frame_pixel(f, x, y)];
            if (!last)
                tally.doubt = fmax(tally.doubt, doubt(f, x, y));
            if (error < INFINITY) {
                tally.squares += error * error;
                tally.worst = fmax(tally.worst, error);
            } else {
                tally.unknown++;
            }
        }
    }
    return tally;
}

void refine_tile(void *context, size_t item, unsigned worker)
{
    struct frame *f = context;
    size_t number = f->order[item];
    struct tally *tally = &f->tallies[number];
    if (frame_given_up(f))
        return;
    if (!f->refiners[worker])
        f->refiners[worker] = mem_zalloc(1, sizeof **f->refiners);
    struct refiner *r = f->refiners[worker];
    r->tile = tiling_at(&f->tiling, number);
    r->n = 0;
    r->most = tally->most;
    memset(r->at, 0, sizeof r->at);
    for (uint32_t y = r->tile.y0; y < r->tile.y1; y++)
        for (uint32_t x = r->tile.x0; x < r->tile.x1; x++)
            take_pixel(f, r, x, y);
    const bool *given_up = &f->workers[worker]->given_up;
    while (r->n > 0 && !frame_late(f, worker) && !*given_up)
        cut_active(f, r, worker);
    if (*given_up && f->deadline == INFINITY)
        return;
    for (uint32_t i = 0; i < r->n && !*given_up; i++)
        finish_pixel(f, r, &r->active[i], false);
    bool last = f->deadline == INFINITY || frame_late(f, worker);
    *tally = tally_of(f, &r->tile, last);
    tally->most = r->most;
    if (f->deadline == INFINITY)
        render_tell_finished(f->tracer->options, number);
    frame_report(f, worker);
}
