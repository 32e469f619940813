/* The grammar of VRML 2.0 files (ISO/IEC 14772-1:1997, annex A) as far as UV lists need it: which
 * fields a node may have, and of what type, is not checked.
 *
 * Things start at `file`.  Actions tell src/convert/wrl.c what opens, closes and is named.  As in
 * mesh files the first syntax error ends the reading. */

%require "3.8"
%language "C"
%define api.pure full
%define api.prefix {vrml_}
%define api.token.prefix {WRL_}
%define api.location.type {struct span}
%define parse.error custom
%define parse.lac full
%locations
%expect 0
%param {struct wrl *w}

%code requires {
#include "convert/wrl.h"
}

%union {
    size_t mark;
}

%code provides {
int vrml_lex(VRML_STYPE *value, struct span *span, struct wrl *w);

/* The scanner, grammar/wrl.l; flex ends the current token in the text with a NUL, wrl_release puts
 * the text's own byte back. */
#define WRL_DECL int wrl_scan(struct span *span, void *yyscanner)
WRL_DECL;
void wrl_release(void *yyscanner);
}

%code top {
#include "config.h"
}

%code {
#define YYMAXDEPTH 4096
#define YYLLOC_DEFAULT(now, rhs, n)                                                                \
    ((now) = (n) ? span_join(YYRHSLOC(rhs, 1), YYRHSLOC(rhs, n))                                   \
                 : (struct span){YYRHSLOC(rhs, 0).end, YYRHSLOC(rhs, 0).end})

static void vrml_error(const struct span *span, struct wrl *w, const char *message);
}

%token END 0 "end of file"
%token DEF "'DEF'" USE "'USE'" PROTO "'PROTO'" EXTERNPROTO "'EXTERNPROTO'"
%token ROUTE "'ROUTE'" TO "'TO'" IS "'IS'" NULL "'NULL'"
%token FIELD "'field'" EVENT "'eventIn' or 'eventOut'"
%token NAME "name" NUMBER "number" STRING "string" BOOL "'TRUE' or 'FALSE'"
%token LBRACE "'{'" RBRACE "'}'" LBRACKET "'['" RBRACKET "']'" DOT "'.'"

%nterm <mark> mark

%%

file:
  statements END
;

statements:
  %empty
| statements statement
;

statement:
  node_statement
| prototype
| route
;

node_statement:
  node
| DEF NAME mark node  { wrl_define(w, @NAME, $mark); }
| USE NAME            { wrl_use(w, @NAME); }
;

mark:
  %empty  { $$ = wrl_mark(w); }
;

node:
  open_node elements RBRACE  { wrl_close_node(w); }
;

open_node:
  NAME LBRACE  { wrl_open_node(w, @NAME); }
;

elements:
  %empty
| elements element
;

element:
  field_name value
| NAME IS NAME
| declaration   /* of a Script */
| EVENT NAME NAME IS NAME
| FIELD NAME NAME IS NAME
| prototype
| route
;

field_name:
  NAME  { wrl_begin_field(w, @NAME); }
;

value:
  numbers
| STRING
| BOOL
| NULL
| node_statement
| LBRACKET items RBRACKET
;

numbers:
  NUMBER          { wrl_add_number(w, @1); }
| numbers NUMBER  { wrl_add_number(w, @2); }
;

items:
  %empty
| items NUMBER  { wrl_add_number(w, @2); }
| items STRING
| items BOOL
| items node_statement
;

route:
  ROUTE NAME DOT NAME TO NAME DOT NAME
;

/* ---- prototypes ---- */

prototype:
  open_prototype NAME LBRACKET declarations RBRACKET LBRACE statements RBRACE
    { wrl_close_prototype(w, @NAME); }
| EXTERNPROTO NAME LBRACKET promises RBRACKET addresses
;

open_prototype:
  PROTO  { wrl_open_prototype(w); }
;

declarations:
  %empty
| declarations declaration
;

declaration:
  EVENT NAME NAME
| FIELD NAME reference value  { wrl_declare(w, false); }
;

reference:
  NAME  { wrl_declare(w, true); }
;

promises:
  %empty
| promises EVENT NAME NAME
| promises FIELD NAME NAME
;

addresses:
  STRING
| LBRACKET strings RBRACKET
;

strings:
  %empty
| strings STRING
;

%%

enum { EXPECTED_MOST = 4 }; /* longer lists help nobody */

static int yyreport_syntax_error(const yypcontext_t *context, struct wrl *w)
{
    yysymbol_kind_t expected[EXPECTED_MOST];
    const char *names[EXPECTED_MOST];
    int n = yypcontext_expected_tokens(context, expected, EXPECTED_MOST);
    if (n == YYENOMEM)
        return YYENOMEM;
    for (int i = 0; i < n; i++)
        names[i] = yysymbol_name(expected[i]);
    wrl_syntax_error(w, *yypcontext_location(context),
                     yypcontext_token(context) == YYSYMBOL_YYEOF, names, (size_t)(n > 0 ? n : 0));
    return 0;
}

/* Only called when the stack is at its limit. */
static void vrml_error(const struct span *span, struct wrl *w, const char *message)
{
    (void)message;
    wrl_stop(w, DIAG_TOO_DEEP, *span, "nested too deeply, so the rest is not read");
}
