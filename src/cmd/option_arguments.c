#include "config.h"

#include "cmd/option_arguments.h"

#include "base/num.h"
#include "base/thread.h"
#include "farm/parts.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool read_whole(const char *text, uint64_t least, uint64_t most, uint64_t *out)
{
    char *end;
    if (text[0] < '0' || text[0] > '9')
        return false;
    errno = 0;
    unsigned long long x = strtoull(text, &end, 10);
    *out = x;
    return *end == 0 && errno == 0 && x >= least && x <= most;
}

static bool take_between(const struct opt_row *row, const char *text, uint64_t least, uint64_t most,
                         uint64_t *out)
{
    if (read_whole(text, least, most, out))
        return true;
    usage_error("--%s takes a whole number from %llu to %llu, not '%s'", row->name,
                (unsigned long long)least, (unsigned long long)most, text);
    return false;
}

static void *member_of(const struct opt_row *row, struct options *out)
{
    return (char *)out + row->member;
}

bool take_flag(const struct opt_row *row, const char *text, struct options *out)
{
    (void)text;
    return *(bool *)member_of(row, out) = true;
}

bool take_text(const struct opt_row *row, const char *text, struct options *out)
{
    *(const char **)member_of(row, out) = text;
    return true;
}

bool take_whole(const struct opt_row *row, const char *text, struct options *out)
{
    uint64_t x = 0;
    bool right = take_between(row, text, row->least, row->most, &x);
    *(uint32_t *)member_of(row, out) = (uint32_t)x;
    return right;
}

#define ADAPTIVE_ERROR (1.0 / 255)

/* A number, or one divided by another. */
static bool read_ratio(const char *text, double *out)
{
    const char *end = text + strlen(text), *slash = strchr(text, '/');
    double divisor = 1;
    if (num_parse(text, slash ? slash : end, out) != (slash ? slash : end))
        return false;
    if (slash && num_parse(slash + 1, end, &divisor) != end)
        return false;
    *out /= divisor;
    return true;
}

bool take_adaptive(const struct opt_row *row, const char *text, struct options *out)
{
    out->adaptive = ADAPTIVE_ERROR;
    if (!text || (read_ratio(text, &out->adaptive) && out->adaptive > 0 && out->adaptive < 1))
        return true;
    usage_error("--%s takes an error between 0 and 1, as in 0.01 or 1/255, not '%s'", row->name,
                text);
    return false;
}

bool take_time(const struct opt_row *row, const char *text, struct options *out)
{
    const char *end = text + strlen(text);
    if (num_parse(text, end, &out->time) == end && out->time > 0 && out->time < INFINITY) {
        out->adaptive = out->adaptive > 0 ? out->adaptive : ADAPTIVE_ERROR;
        return true;
    }
    usage_error("--%s takes a number of seconds, not '%s'", row->name, text);
    return false;
}

/* `n` whole numbers with a separator between them. */
static bool read_list(const char *text, char separator, unsigned n, uint32_t *out)
{
    for (unsigned i = 0; i < n; i++) {
        char *end;
        if (text[0] < '0' || text[0] > '9')
            return false;
        unsigned long x = strtoul(text, &end, 10);
        if (x > UINT32_MAX || *end != (i + 1 < n ? separator : 0))
            return false;
        out[i] = (uint32_t)x;
        text = end + 1;
    }
    return true;
}

bool take_bits(const struct opt_row *row, const char *text, struct options *out)
{
    uint64_t x = 0;
    if (read_whole(text, 8, 32, &x) && (x == 8 || x == 16 || x == 32)) {
        out->bits = (uint32_t)x;
        return true;
    }
    usage_error("--%s takes 8, 16 or 32, not '%s'", row->name, text);
    return false;
}

bool take_exposure(const struct opt_row *row, const char *text, struct options *out)
{
    const char *end = text + strlen(text);
    if (num_parse(text, end, &out->exposure) == end && fabs(out->exposure) <= 100)
        return true;
    usage_error("--%s takes a number of stops from -100 to 100, not '%s'", row->name, text);
    return false;
}

bool take_part(const struct opt_row *row, const char *text, struct options *out)
{
    uint32_t part[2];
    if (read_list(text, '/', 2, part) && part[0] >= 1 && part[0] <= part[1] &&
        part[1] <= PARTS_MOST) {
        out->part = part[0];
        out->parts = part[1];
        return true;
    }
    usage_error("--%s takes I/N, as in 3/7, with I from 1 to N and N up to %d, not '%s'", row->name,
                PARTS_MOST, text);
    return false;
}

bool take_frames(const struct opt_row *row, const char *text, struct options *out)
{
    const char *dots = strstr(text, "..");
    uint64_t first, last;
    char begin[16] = "";
    if (dots && (size_t)(dots - text) < sizeof begin) {
        memcpy(begin, text, (size_t)(dots - text));
        if (read_whole(begin, 0, UINT32_MAX - 1, &first) &&
            read_whole(dots + 2, first, UINT32_MAX - 1, &last)) {
            out->frames[0] = (uint32_t)first;
            out->frames[1] = (uint32_t)last;
            return out->animated = true;
        }
    }
    usage_error("--%s takes A..B, as in 1..240, with A not above B, not '%s'", row->name, text);
    return false;
}

bool take_seed(const struct opt_row *row, const char *text, struct options *out)
{
    return out->seeded = take_between(row, text, 0, UINT64_MAX, &out->seed);
}

bool take_max_objects(const struct opt_row *row, const char *text, struct options *out)
{
    uint64_t x = 0;
    bool right = take_between(row, text, 1, UINT32_MAX, &x);
    out->max_objects = (size_t)x;
    return right;
}

bool take_max_rays(const struct opt_row *row, const char *text, struct options *out)
{
    return take_between(row, text, 1, UINT64_MAX, &out->max_rays);
}

/* A number of bytes, with K, M or G for powers of 1024. */
bool take_max_memory(const struct opt_row *row, const char *text, struct options *out)
{
    static const char units[] = "KMG";
    enum { MOST_DIGITS = 20 };
    char digits[MOST_DIGITS + 1] = "";
    size_t n = strspn(text, "0123456789");
    const char *unit = text[n] ? strchr(units, text[n]) : NULL;
    unsigned shift = unit ? 10 * (unsigned)(unit - units + 1) : 0;
    if (n <= MOST_DIGITS)
        memcpy(digits, text, n);
    if (!text[n + (unit != NULL)] && read_whole(digits, 1, UINT64_MAX >> shift, &out->max_memory)) {
        out->max_memory <<= shift;
        return true;
    }
    usage_error("--%s takes a number of bytes, as in 2000000 or 512M, not '%s'", row->name, text);
    return false;
}

bool take_res(const struct opt_row *row, const char *text, struct options *out)
{
    uint32_t size[2];
    if (!read_list(text, 'x', 2, size)) {
        usage_error("--%s takes WIDTHxHEIGHT, as in 640x480, not '%s'", row->name, text);
        return false;
    }
    if (!image_size_allowed(size[0], size[1])) {
        usage_error("--res: a picture has 1 to %d pixels, at most %d along a side",
                    IMAGE_PIXEL_LIMIT, IMAGE_SIDE_LIMIT);
        return false;
    }
    out->width = size[0];
    out->height = size[1];
    return true;
}

bool take_crop(const struct opt_row *row, const char *text, struct options *out)
{
    uint32_t *c = out->crop;
    if (!read_list(text, ',', 4, c) || c[0] >= c[2] || c[1] >= c[3]) {
        usage_error("--%s takes X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1, not '%s'", row->name, text);
        return false;
    }
    return out->cropped = true;
}

bool take_pixel(const struct opt_row *row, const char *text, struct options *out)
{
    if (!read_list(text, ',', 2, out->pixel)) {
        usage_error("--%s takes X,Y, not '%s'", row->name, text);
        return false;
    }
    return out->behind = true;
}

/* The number of a word in a list that ends with NULL; -1 after reporting another. */
static int take_word(const struct opt_row *row, const char *text, const char *const *words)
{
    struct str_nearest nearest = str_nearest_to(str_of(text));
    char list[128] = "";
    for (int i = 0; words[i]; i++) {
        if (strcmp(text, words[i]) == 0)
            return i;
        str_nearest_try(&nearest, str_of(words[i]));
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s'%s'",
                 i == 0         ? ""
                 : words[i + 1] ? ", "
                                : " or ",
                 words[i]);
    }
    struct str meant = str_nearest_found(&nearest);
    if (meant.n)
        usage_error("--%s takes %s, not '%s'; did you mean '%.*s'?", row->name, list, text,
                    STR_ARG(meant));
    else
        usage_error("--%s takes %s, not '%s'", row->name, list, text);
    return -1;
}

bool take_show(const struct opt_row *row, const char *text, struct options *out)
{
    static const char *const words[] = {"normals", "depth", "ids", "samples", NULL};
    static const enum render_show shows[] = {SHOW_NORMALS, SHOW_DEPTH, SHOW_IDS, SHOW_SAMPLES};
    int i = take_word(row, text, words);
    out->show = i >= 0 ? shows[i] : SHOW_PICTURE;
    return i >= 0;
}

bool take_format(const struct opt_row *row, const char *text, struct options *out)
{
    static const char *const words[] = {"text", "json", "sarif", NULL};
    static const enum diag_format formats[] = {DIAG_FORMAT_TEXT, DIAG_FORMAT_JSON,
                                               DIAG_FORMAT_SARIF};
    int i = take_word(row, text, words);
    out->format = formats[i > 0 ? i : 0];
    return i >= 0;
}

bool take_stats(const struct opt_row *row, const char *text, struct options *out)
{
    static const char *const words[] = {"json", NULL};
    out->stats = text ? STATS_JSON : STATS_TEXT;
    return !text || take_word(row, text, words) >= 0;
}

bool take_fix(const struct opt_row *row, const char *text, struct options *out)
{
    static const char *const words[] = {"all", NULL};
    out->fix = text ? FIX_ALL : FIX_SAFE;
    return !text || take_word(row, text, words) >= 0;
}

static bool unknown_rule(const struct opt_row *row, struct str name)
{
    struct diag_selection which;
    struct str meant = diag_nearest_name(name), rest = {name.at + 3, name.n - 3};
    if (str_begins(name, "no-") && diag_select(rest, &which))
        usage_error("--%s: no rule is called '%.*s'; use --no-warn %.*s", row->name, STR_ARG(name),
                    STR_ARG(rest));
    else if (meant.n)
        usage_error("--%s: no rule is called '%.*s'; did you mean '%.*s'?", row->name,
                    STR_ARG(name), STR_ARG(meant));
    else
        usage_error("--%s: no rule is called '%.*s'; 'wrt lint --list' names them", row->name,
                    STR_ARG(name));
    return false;
}

static bool is_error(const struct diag_selection *which)
{
    for (int i = 0; i < DIAG_CODES; i++)
        if (which->has[i] && diag_rules[i].level != DIAG_ERROR)
            return false;
    return true;
}

/* Sets what becomes of rules: names of rules and groups with commas between. */
static bool set_rules(const struct opt_row *row, const char *names, enum diag_setting setting,
                      struct options *out)
{
    for (const char *at = names;; at++) {
        struct str name = {at, strcspn(at, ",")};
        struct diag_selection which;
        if (!diag_select(name, &which))
            return unknown_rule(row, name);
        if (is_error(&which)) {
            usage_error("--%s: '%.*s' is an error: errors are always told", row->name,
                        STR_ARG(name));
            return false;
        }
        diag_policy_set(&out->policy, &which, setting);
        at += name.n;
        if (!*at)
            return true;
    }
}

/* NAME,..., error, or error=NAME,... */
bool take_warn(const struct opt_row *row, const char *text, struct options *out)
{
    static const char error[] = "error=";
    if (strcmp(text, "error") == 0)
        return out->policy.warnings_are_errors = true;
    if (strncmp(text, error, strlen(error)) == 0)
        return set_rules(row, text + strlen(error), DIAG_AS_ERROR, out);
    return set_rules(row, text, DIAG_ON, out);
}

bool take_no_warn(const struct opt_row *row, const char *text, struct options *out)
{
    return set_rules(row, text, DIAG_OFF, out);
}

bool take_accel(const struct opt_row *row, const char *text, struct options *out)
{
    static const char *const words[] = {"none", NULL};
    out->brute_force = true;
    return take_word(row, text, words) >= 0;
}

/* Names with commas between them; none: all there are, and the vector code with them. */
bool take_no_skip(const struct opt_row *row, const char *text, struct options *out)
{
    const char *words[SKIPS + 1] = {NULL};
    for (int i = 0; i < SKIPS; i++)
        words[i] = skip_rows[i].name;
    if (!text)
        out->no_skip = NO_SKIP_ALL;
    while (text) {
        char word[32];
        const char *comma = strchr(text, ',');
        snprintf(word, sizeof word, "%.*s", comma ? (int)(comma - text) : (int)strlen(text), text);
        int i = take_word(row, word, words);
        if (i < 0)
            return false;
        out->no_skip |= UINT32_C(1) << i;
        text = comma ? comma + 1 : NULL;
    }
    return true;
}

bool take_isa(const struct opt_row *row, const char *text, struct options *out)
{
    const char *words[ISA_COUNT + 1] = {NULL};
    for (int i = 0; i < ISA_COUNT; i++)
        words[i] = isa_name((enum isa)i);
    int i = take_word(row, text, words);
    if (i < 0)
        return false;
    out->isa = (enum isa)i;
    if (!isa_available(out->isa))
        usage_error("--isa: this machine or build has no %s", words[i]);
    return isa_available(out->isa);
}

bool take_define(const struct opt_row *row, const char *text, struct options *out)
{
    const char *equals = strchr(text, '=');
    if (!equals || equals == text) {
        usage_error("--%s takes NAME=VALUE, not '%s'", row->name, text);
        return false;
    }
    vec_push(&out->defines, text);
    return true;
}

bool take_include(const struct opt_row *row, const char *text, struct options *out)
{
    (void)row;
    vec_push(&out->folders, text);
    return true;
}

/* What is to be better the smaller it is, by its name. */
static enum measure find_limited(struct str name)
{
    for (int i = 0; i < MEASURES; i++)
        if (i != MEASURE_PSNR && str_is(name, measure_names[i]))
            return (enum measure)i;
    return MEASURES;
}

/* N or NAME=N */
bool take_fail_above(const struct opt_row *row, const char *text, struct options *out)
{
    const char *equals = strchr(text, '='), *number = equals ? equals + 1 : text;
    const char *end = number + strlen(number);
    enum measure which =
        equals ? find_limited((struct str){text, (size_t)(equals - text)}) : MEASURE_MAX;
    double limit = 0;
    if (which == MEASURES || num_parse(number, end, &limit) != end || !(limit >= 0)) {
        usage_error("--%s takes N or NAME=N, not '%s'; N is 0 or more, and NAME max, rmse, mae, "
                    "p99.9, above or flip",
                    row->name, text);
        return false;
    }
    out->limits[which] = limit;
    return out->limited = true;
}
