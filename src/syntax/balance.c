/* XML tags made a tree: the grammar sees every element closed once, in order, whatever the text
 * holds.  Each mistake is reported here, once, with both tags. */
#include "config.h"

#include "syntax/parser.h"

#include "grammar/scene.tab.h"

static void open_tag(struct parser *p, struct str name, struct span span)
{
    vec_push(&p->open, (struct open_element){name, span});
    if (p->open.n > NESTING_LIMIT)
        parser_stop(p, DIAG_TOO_DEEP, span,
                    "elements nested deeper than 256 levels, so the rest is not read");
}

/* How many elements a closing tag of this name closes; 0: none has the name. */
static size_t closed_by(const struct parser *p, struct str name)
{
    for (size_t i = p->open.n; i > 0; i--)
        if (str_equal(p->open.at[i - 1].name, name))
            return p->open.n - i + 1;
    return 0;
}

static void label_opening(struct diag_entry *e, const struct open_element *o)
{
    diag_label(e, o->span, "'%.*s' is opened here", STR_ARG(o->name));
}

static void report_unclosed(struct parser *p, struct span span, struct str closing)
{
    const struct open_element *top = &p->open.at[p->open.n - 1];
    struct diag_entry *e =
        diag_report(p->diag, DIAG_XML_CLOSING_TAG, span, "'</%.*s>' comes before '%.*s' is closed",
                    STR_ARG(closing), STR_ARG(top->name));
    label_opening(e, top);
    struct span before = {span.begin, span.begin};
    diag_fix(e, before, DIAG_FIX_MAYBE, "</%.*s>", STR_ARG(top->name));
}

static void report_wrong_name(struct parser *p, struct span span, struct str closing)
{
    const struct open_element *top = &p->open.at[p->open.n - 1];
    struct diag_entry *e = diag_report(p->diag, DIAG_XML_CLOSING_TAG, span,
                                       "'</%.*s>' closes nothing; the element to close is '%.*s'",
                                       STR_ARG(closing), STR_ARG(top->name));
    label_opening(e, top);
    diag_fix(e, span, DIAG_FIX_MAYBE, "</%.*s>", STR_ARG(top->name));
}

static int close_tag(struct parser *p, struct str name, struct span span)
{
    if (!p->open.n)
        return TOKEN_XML_CLOSE; /* a syntax error behind the root */
    name = str_trim(name);
    size_t n = closed_by(p, name);
    if (n == 0 && !p->feigned)
        report_wrong_name(p, span, name);
    else if (n > 1)
        report_unclosed(p, span, name);
    p->closes_due = n > 1 ? n - 1 : 0;
    p->open.n--;
    return TOKEN_XML_CLOSE;
}

static int end_of_text(struct parser *p, struct span span)
{
    if (!p->open.n || p->stopped)
        return TOKEN_END;
    const struct open_element *top = &p->open.at[p->open.n - 1];
    struct diag_entry *e = diag_report(p->diag, DIAG_XML_CLOSING_TAG, span,
                                       "the text ends before '%.*s' is closed", STR_ARG(top->name));
    label_opening(e, top);
    p->closes_due = p->open.n - 1;
    p->open.n--;
    p->feigned = true;
    return TOKEN_XML_CLOSE;
}

int xml_balance(struct parser *p, int token, struct span span, struct str name)
{
    switch (token) {
    case TOKEN_XML_OPEN:
        open_tag(p, name, span);
        return token;
    case TOKEN_XML_EMPTY_END:
        p->open.n -= p->open.n > 0;
        return token;
    case TOKEN_XML_CLOSE:
        return close_tag(p, name, span);
    case TOKEN_END:
        return end_of_text(p, span);
    default:
        return token;
    }
}

bool xml_close_due(struct parser *p)
{
    if (!p->closes_due)
        return false;
    p->closes_due--;
    p->open.n--;
    return true;
}
