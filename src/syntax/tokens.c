/* The stream of tokens: which scanner, where each token lies, when to stop. */
#include "config.h"

#include "syntax/parser.h"
#include "syntax/syntax.h"

#include "grammar/scene.tab.h"

void parser_untake(struct parser *p, size_t n)
{
    p->at -= (uint32_t)n;
}

void parser_trivia(struct parser *p, enum trivia_kind kind, struct span span)
{
    vec_push(&p->ast->trivia, (struct trivia){span, kind});
}

void parser_stop(struct parser *p, enum diag_code code, struct span span, const char *message)
{
    if (!p->stopped)
        diag_report(p->diag, code, span, "%s", message);
    p->stopped = true;
}

bool parser_nest(struct parser *p, struct span span)
{
    p->bracket_at = span.begin;
    p->depth_before = p->depth;
    if (p->depth < NESTING_LIMIT) {
        p->brackets[p->depth++] = span;
        return true;
    }
    parser_stop(p, DIAG_TOO_DEEP, span,
                "brackets nested deeper than 256 levels, so the rest is not read");
    return false;
}

char parser_bracket(const struct parser *p)
{
    return p->depth ? p->source->text[p->brackets[p->depth - 1].begin - p->source->base] : 0;
}

/* A brace closes the innermost open one and what is left open inside; other brackets close nothing
 * around the block they stand in. */
void parser_unnest(struct parser *p, char opening, uint32_t at)
{
    p->bracket_at = at;
    p->depth_before = p->depth;
    while (p->depth && parser_bracket(p) != opening && (opening == '{' || parser_bracket(p) != '{'))
        p->depth--;
    if (parser_bracket(p) == opening) {
        p->depth--;
    } else {
        p->depth = p->depth_before;
        p->unmatched = at;
    }
}

void parser_hold(struct parser *p, int token, struct str text, struct span span)
{
    p->now = p->previous;
    p->held[p->held_count++] = (struct held){token, text, span};
}

struct span span_of_trimmed(struct span span, struct str text)
{
    struct str visible = str_trim(text);
    uint32_t begin = span.begin + (uint32_t)(visible.at - text.at);
    return (struct span){begin, begin + (uint32_t)visible.n};
}

/* The token that waits. */
static int take_held(SCENE_STYPE *value, struct span *span, struct parser *p)
{
    const struct held *h = &p->held[--p->held_count];
    *span = h->span;
    value->text = h->text;
    return h->token;
}

static int next_xml(SCENE_STYPE *value, struct span *span, struct parser *p)
{
    *span = (struct span){p->at, p->at};
    p->feigned = true;
    if (p->tag_end_due) {
        p->tag_end_due = false;
        return TOKEN_XML_TAG_END;
    }
    if (xml_close_due(p))
        return TOKEN_XML_CLOSE;
    int token;
    p->feigned = false;
    if (p->held_count) {
        token = take_held(value, span, p);
        return xml_balance(p, token, *span, value->text);
    }
    do {
        p->feigned = false;
        do /* blanks around the root element mean nothing, nor do those right behind a tag */
            token = xml_scan(value, span, p->scanner);
        while (token == TOKEN_XML_TEXT && (!p->open.n || p->behind_tag) &&
               !str_trim(value->text).n);
        p->behind_tag = token != TOKEN_XML_TEXT;
        p->feigned |= p->tag_end_due;
        if (token == TOKEN_XML_TEXT && !p->open.n)
            *span = span_of_trimmed(*span, value->text);
        token = xml_balance(p, token, *span, value->text);
    } while (token == XML_SKIPPED);
    return token;
}

static int next_native(SCENE_STYPE *value, struct span *span, struct parser *p)
{
    int token = p->held_count
                    ? take_held(value, span, p)
                    : parser_mend_slip(p, native_scan(value, span, p->scanner), *span, value->text);
    bool feigned = token == TOKEN_RBRACE && span->begin == span->end;
    int missing = feigned ? 0 : parser_missing_token(p, span->begin);
    if (missing) {
        p->held[p->held_count++] = (struct held){token, value->text, *span};
        *span = (struct span){p->now.end, p->now.end};
        token = missing;
    }
    p->since++;
    parser_trail(p, token);
    p->member_due = parser_member_follows(p, token);
    return token;
}

int scene_lex(SCENE_STYPE *value, struct span *span, struct parser *p)
{
    bool xml = p->ast->xml;
    *span = (struct span){p->at, p->at};
    value->text = (struct str){0};
    if (p->start) {
        int start = p->start;
        p->start = 0;
        return start;
    }
    int token = p->stopped ? TOKEN_END
                : xml      ? next_xml(value, span, p)
                           : next_native(value, span, p);
    p->previous = p->now;
    p->now = *span;
    if (p->ast->nodes > NODE_LIMIT)
        parser_stop(
            p, DIAG_SCENE_TOO_LARGE, *span,
            "the text has more elements or values than can be held, so the rest is not read");
    return p->stopped ? TOKEN_END : token;
}

bool syntax_is_keyword(struct str word)
{
    static const char keywords[] = "wrt model let param material texture true false include fn "
                                   "default define assert for in if else";
    struct str keyword;
    for (unsigned i = 0; (keyword = str_nth_word(keywords, i)).n; i++)
        if (str_equal(keyword, word))
            return true;
    return false;
}
