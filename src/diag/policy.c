/* Rules by name, switched on and off by the command line and by comments of the text. */
#include "config.h"

#include "diag/policy.h"

#include <string.h>

/* ---- names ----------------------------------------------------------------------------------- */

static bool is_code(const struct diag_rule *rule, struct str name)
{
    size_t n = strlen(rule->code);
    if (str_is(name, rule->slug))
        return true;
    if (name.n < n || !str_equal_nocase((struct str){name.at, n}, str_of(rule->code)))
        return false;
    return name.n == n ||
           (name.at[n] == '-' && str_is((struct str){name.at + n + 1, name.n - n - 1}, rule->slug));
}

static bool is_of(const struct diag_rule *rule, struct str name)
{
    if (str_is(name, "all"))
        return rule->level != DIAG_ERROR;
    return name.n > 0 && str_is(name, diag_groups[rule->group].name);
}

bool diag_select(struct str name, struct diag_selection *out)
{
    bool any = false;
    for (int i = 0; i < DIAG_CODES; i++) {
        out->has[i] = is_code(&diag_rules[i], name) || is_of(&diag_rules[i], name);
        any |= out->has[i];
    }
    return any;
}

struct str diag_nearest_name(struct str name)
{
    struct str_nearest nearest = str_nearest_to(name);
    for (int i = 0; i < DIAG_CODES; i++)
        str_nearest_try(&nearest, str_of(diag_rules[i].slug));
    for (int i = DIAG_NONE + 1; i < DIAG_GROUPS; i++)
        str_nearest_try(&nearest, str_of(diag_groups[i].name));
    str_nearest_try(&nearest, str_of("all"));
    return str_nearest_found(&nearest);
}

void diag_policy_set(struct diag_policy *p, const struct diag_selection *which,
                     enum diag_setting setting)
{
    for (int i = 0; i < DIAG_CODES; i++)
        if (which->has[i] && diag_rules[i].level != DIAG_ERROR)
            p->of[i] = (uint8_t)setting;
}

/* ---- levels ---------------------------------------------------------------------------------- */

/* By the policy alone; false: off. */
static bool level_of(const struct diag_policy *p, enum diag_code code, enum diag_level *level)
{
    enum diag_setting setting = p ? (enum diag_setting)p->of[code] : DIAG_AS_USUAL;
    *level = diag_rules[code].level;
    if (setting == DIAG_AS_ERROR ||
        (*level == DIAG_WARNING && setting != DIAG_OFF && p && p->warnings_are_errors))
        *level = DIAG_ERROR;
    if (diag_is_lint(code) && !(p && p->lint))
        return false;
    return setting != DIAG_OFF && (setting != DIAG_AS_USUAL || !diag_is_optional(code));
}

bool diag_wants(const struct diag *d, enum diag_code code)
{
    enum diag_level level;
    return level_of(d->policy, code, &level);
}

/* Whether a comment silences it; every comment that would is used. */
static bool is_allowed(struct diag *d, enum diag_code code, struct span span)
{
    bool allowed = false;
    for (size_t i = 0; i < d->allows.n; i++) {
        struct diag_allow *a = &d->allows.at[i];
        if (!a->selection.has[code] || span.begin < a->where.begin || span.begin >= a->where.end)
            continue;
        allowed = a->used = true;
    }
    return allowed;
}

bool diag_level_here(struct diag *d, enum diag_code code, struct span span, enum diag_level *level)
{
    if (!level_of(d->policy, code, level))
        return false;
    return diag_rules[code].level == DIAG_ERROR || !is_allowed(d, code, span);
}

bool diag_is_crowded(struct diag *d, enum diag_code code, struct span span)
{
    struct {
        const struct source *source;
        uint64_t code;
    } key = {srcmap_source(d->sources, span.begin), code};
    struct diag_crowd *crowd = map_get(&d->crowds, (struct str){(const char *)&key, sizeof key});
    if (!crowd) {
        crowd = arena_zalloc(&d->arena, 1, sizeof *crowd);
        *crowd = (struct diag_crowd){.next = d->crowded, .source = key.source, .code = code};
        d->crowded = crowd;
        map_set(&d->crowds,
                (struct str){arena_copy(&d->arena, (const char *)&key, sizeof key), sizeof key},
                crowd);
    }
    return crowd->n++ >= DIAG_RULE_LIMIT;
}

/* ---- comments -------------------------------------------------------------------------------- */

void diag_allow(struct diag *d, struct span where, struct span name)
{
    struct diag_allow allow = {.where = where, .name = name};
    struct str text = srcmap_text(d->sources, name);
    if (!diag_select(text, &allow.selection)) {
        struct diag_entry *e =
            diag_report(d, DIAG_UNUSED_ALLOW, name, "no rule is called '%.*s'; nothing is allowed",
                        STR_ARG(text));
        diag_did_you_mean(e, name, diag_nearest_name(text));
        return;
    }
    vec_push(&d->allows, allow);
}

static bool selects_only_errors(const struct diag_selection *s)
{
    for (int i = 0; i < DIAG_CODES; i++)
        if (s->has[i] && diag_rules[i].level != DIAG_ERROR)
            return false;
    return true;
}

/* Whether any of these rules is on: what nobody looked for is not found. */
static bool selects_wanted(const struct diag *d, const struct diag_selection *s)
{
    for (int i = 0; i < DIAG_CODES; i++)
        if (s->has[i] && diag_rules[i].level != DIAG_ERROR && diag_wants(d, (enum diag_code)i))
            return true;
    return false;
}

void diag_report_unused_allows(struct diag *d)
{
    for (size_t i = 0; i < d->allows.n; i++) {
        const struct diag_allow *a = &d->allows.at[i];
        struct str name = srcmap_text(d->sources, a->name);
        if (selects_only_errors(&a->selection))
            diag_report(d, DIAG_UNUSED_ALLOW, a->name,
                        "'%.*s' is an error, which no comment allows", STR_ARG(name));
        else if (!a->used && selects_wanted(d, &a->selection))
            diag_report(d, DIAG_UNUSED_ALLOW, a->name, "'%.*s' is allowed here, and not found",
                        STR_ARG(name));
    }
}
