/* The grammar of both scene formats.
 *
 * Things start at `input`: the first token says which format follows.  Actions call one
 * constructor or append to a list; everything else (names, types, ranges) is for later stages.
 * `error` recovers at members and statements only. */

%require "3.8"
%language "C"
%define api.pure full
%define api.prefix {scene_}
%define api.token.prefix {TOKEN_}
%define api.location.type {struct span}
%define parse.error custom
%define parse.lac full
%locations
%expect 0
%param {struct parser *p}

%code requires {
#include "syntax/parser.h"
}

%union {
    struct str text;
    struct ast_node *node;
    struct ast_list list;
    struct xml_content content;
}

%code provides {
/* The next token of the text, whichever scanner it comes from (syntax/tokens.c). */
int scene_lex(SCENE_STYPE *value, struct span *span, struct parser *p);

/* The two scanners, grammar/native.l and grammar/xml.l. */
#define NATIVE_DECL int native_scan(SCENE_STYPE *value, struct span *span, void *yyscanner)
#define XML_DECL int xml_scan(SCENE_STYPE *value, struct span *span, void *yyscanner)
NATIVE_DECL;
XML_DECL;

/* flex ends the current token in the text with a NUL; these put the text's own byte back. */
void native_release(void *yyscanner);
void xml_release(void *yyscanner);
}

%code top {
#include "config.h"
}

%code {
#define YYMAXDEPTH 4096 /* bounds the depth of the tree, hence later recursion */
#define YYLLOC_DEFAULT(now, rhs, n)                                                                \
    ((now) = (n) ? span_join(YYRHSLOC(rhs, 1), YYRHSLOC(rhs, n))                                   \
                 : (struct span){YYRHSLOC(rhs, 0).end, YYRHSLOC(rhs, 0).end})

static void scene_error(const struct span *span, struct parser *p, const char *message);

/* Behind a syntax error: everything up to the next member or statement is lost, and bison may tell
 * the next error at once (parser_resume sees to it that each time some text was read). */
#define RESUME(lost)                                                                               \
    do {                                                                                           \
        if (yychar != TOKEN_SCENE_EMPTY)                                                                     \
            parser_hold(p, yychar, yylval.text, yylloc);                                           \
        yyclearin;                                                                                 \
        if (parser_resume(p, &(lost)))                                                             \
            yyerrok;                                                                               \
    } while (0)
}

%token END 0            "end of file"
%token START_NATIVE     "native text"
%token START_XML        "XML text"
%token START_VALUE      "value"

/* Native */
%token ORPHAN "'{' of a damaged block" /* syntax/resume.c */
%token <text> NAME "name"
%token <text> NUMBER "number" DEGREES "angle" RADIANS "angle in radians"
%token <text> STRING "string"
%token <text> COLOUR "colour"
%token BAD_VALUE "damaged number" /* reported */
%token <text> MEMBER "member" OPENING "member up to its '{'" /* several as one: syntax/members.c */
%token WRT "'wrt'" MODEL "'model'" LET "'let'" PARAM "'param'"
%token <text> MATERIAL "'material'" TEXTURE "'texture'"
%token INCLUDE "'include'" FN "'fn'" DEFAULT "'default'" DEFINE "'define'" ASSERT "'assert'"
%token FOR "'for'" IN "'in'" IF "'if'" ELSE "'else'"
%token TRUE "'true'" FALSE "'false'"
%token LBRACE "'{'" RBRACE "'}'" LPAREN "'('" RPAREN "')'" LBRACKET "'['" RBRACKET "']'"
%token COMMA "','" SEMICOLON "';'" EQUALS "'='" DOT "'.'"

%token QUESTION "'?'" COLON "':'" OR "'||'" AND "'&&'" EQUAL "'=='" NOT_EQUAL "'!='"
%token LESS "'<'" LESS_EQUAL "'<='" GREATER "'>' of a comparison" GREATER_EQUAL "'>='"
%token PLUS "'+'" MINUS "'-'" STAR "'*'" SLASH "'/'" PERCENT "'%'" NOT "'!'" CARET "'^'"

/* The loosest first. */
%right QUESTION COLON
%left OR
%left AND
%left EQUAL NOT_EQUAL
%left LESS LESS_EQUAL GREATER GREATER_EQUAL
%left PLUS MINUS
%left STAR SLASH PERCENT
%precedence NOT SIGN
%right CARET
%precedence DOT LBRACKET

/* XML; the scanner's side keeps tags balanced (syntax/balance.c) */
%token <text> XML_OPEN "opening tag" XML_ATTRIBUTE "attribute" XML_VALUE "quoted value"
%token <text> XML_TEXT "text" XML_CLOSE "closing tag"
%token XML_EQUALS "'=' of an attribute" XML_TAG_END "'>'" XML_EMPTY_END "'/>'"

%nterm <list> statements members block rest_of_block
%nterm <list> parameters parameter_list arguments argument_list
%nterm <list> values components attributes
%nterm <node> statement if body member
%nterm <node> parameter argument value construct expression
%nterm <node> element attribute
%nterm <text> property_name
%nterm <content> content

%%

input:
  START_NATIVE version statements END { p->ast->statements = ast_concat(p->version, $statements).first; }
| START_XML element END               { p->ast->statements = $element; }
| START_XML error END                 { p->ast->statements = NULL; }
| START_VALUE value END               { p->ast->statements = $value; }
;

/* ---- Native ---- */

version:
  %empty
| WRT NUMBER[n]   { parser_version(p, @$, @n, $n); }
;

statements:
  %empty                      { $$ = (struct ast_list){0}; }
| statements[list] statement  { $$ = ast_append($list, $statement); }
| statements[list] SEMICOLON  { $$ = $list; }
| statements[list] error      { RESUME(@error); $$ = ast_append_error(p->ast, $list, @error); }
;

statement:
  MODEL NAME                         { $$ = ast_named(p->ast, AST_MODEL, @$, $NAME, @NAME); }
| INCLUDE STRING
    { $$ = ast_with(ast_node(p->ast, AST_INCLUDE, @$), ast_text(p->ast, AST_STRING, @2, $2)); }
| LET NAME EQUALS value              { $$ = ast_with(ast_named(p->ast, AST_LET, @$, $NAME, @NAME), $value); }
| PARAM NAME EQUALS value            { $$ = ast_with(ast_named(p->ast, AST_PARAM, @$, $NAME, @NAME), $value); }
| MATERIAL NAME EQUALS value         { $$ = ast_with(ast_named(p->ast, AST_MATERIAL, @$, $NAME, @NAME), $value); }
| TEXTURE NAME EQUALS value          { $$ = ast_with(ast_named(p->ast, AST_TEXTURE, @$, $NAME, @NAME), $value); }
| FN NAME LPAREN parameters RPAREN EQUALS value
    { $$ = ast_holding(ast_named(p->ast, AST_FN, @$, $NAME, @NAME), ast_append($parameters, $value)); }
| DEFINE NAME LPAREN parameters RPAREN body
    { $$ = ast_holding(ast_named(p->ast, AST_DEFINE, @$, $NAME, @NAME), ast_append($parameters, $body)); }
| DEFAULT NAME block
    { $$ = parser_block(p, AST_DEFAULT, @$, $NAME, @NAME, (struct str){0}, $block); }
| DEFAULT NAME[kind] NAME[label] block
    { $$ = parser_block(p, AST_DEFAULT, @$, $kind, @kind, $label, $block); }
| ASSERT expression COMMA expression[message]
    { $$ = ast_holding(ast_node(p->ast, AST_ASSERT, @$), ast_pair($2, $message)); }
| FOR NAME IN expression body
    { $$ = ast_holding(ast_named(p->ast, AST_FOR, @$, $NAME, @NAME), ast_pair($expression, $body)); }
| if
| NAME LPAREN arguments RPAREN
    { $$ = ast_holding(ast_named(p->ast, AST_USE, @$, $NAME, @NAME), $arguments); }
| NAME LPAREN arguments RPAREN body
    { $$ = ast_holding(ast_named(p->ast, AST_USE, @$, $NAME, @NAME), ast_append($arguments, $body)); }
| NAME block
    { $$ = parser_block(p, AST_BLOCK, @$, $NAME, @NAME, (struct str){0}, $block); }
| NAME[kind] NAME[label] block
    { $$ = parser_block(p, AST_BLOCK, @$, $kind, @kind, $label, $block); }
| NAME[kind] NAME[word] NAME[label] block
    { $$ = parser_block(p, AST_BLOCK, @$, $kind, @kind, $word,
                        ast_concat(ast_append((struct ast_list){0}, ast_named(p->ast, AST_LABEL, @label, $label, @label)), $block)); }
| ORPHAN rest_of_block  { $$ = ast_node(p->ast, AST_ERROR, @$); }
;

if:
  IF expression body  { $$ = ast_holding(ast_node(p->ast, AST_IF, @$), ast_pair($2, $3)); }
| IF expression body[then] ELSE body[else]
    { $$ = ast_holding(ast_node(p->ast, AST_IF, @$), ast_append(ast_pair($2, $then), $else)); }
| IF expression body ELSE if[other]
    { $$ = ast_holding(ast_node(p->ast, AST_IF, @$), ast_append(ast_pair($2, $3), $other)); }
;

parameters:
  %empty                { $$ = (struct ast_list){0}; }
| parameter_list
| parameter_list COMMA
;

parameter_list:
  parameter                              { $$ = ast_append((struct ast_list){0}, $1); }
| parameter_list[list] COMMA parameter   { $$ = ast_append($list, $3); }
;

parameter:
  NAME               { $$ = ast_named(p->ast, AST_PARAMETER, @$, $NAME, @NAME); }
| NAME EQUALS value  { $$ = ast_with(ast_named(p->ast, AST_PARAMETER, @$, $NAME, @NAME), $value); }
;

arguments:
  %empty               { $$ = (struct ast_list){0}; }
| argument_list
| argument_list COMMA
;

argument_list:
  argument                             { $$ = ast_append((struct ast_list){0}, $1); }
| argument_list[list] COMMA argument   { $$ = ast_append($list, $3); }
;

argument:
  value
| NAME EQUALS value  { $$ = ast_with(ast_named(p->ast, AST_ARGUMENT, @$, $NAME, @NAME), $value); }
;

body:
  block  { $$ = ast_holding(ast_node(p->ast, AST_BODY, @$), $block); }
;

block:
  LBRACE rest_of_block  { $$ = $2; }
;

rest_of_block:
  members RBRACE  { $$ = $members; }
;

members:
  %empty                    { $$ = (struct ast_list){0}; }
| members[list] member      { $$ = ast_append($list, $member); }
| members[list] COMMA       { $$ = $list; }
| members[list] SEMICOLON   { $$ = $list; }
| members[list] error       { RESUME(@error); $$ = ast_append_error(p->ast, $list, @error); }
;

member:
  MEMBER                 { $$ = parser_member(p, @$, $1); }
| OPENING rest_of_block  { $$ = parser_construct(p, @$, $OPENING, $2); }
| property_name COLON value
    { $$ = ast_with(ast_named(p->ast, AST_PROPERTY, @$, $property_name, @property_name), $value); }
| property_name COLON error
    { RESUME(@error);
      $$ = ast_with(ast_named(p->ast, AST_PROPERTY, @$, $property_name, @property_name),
                    ast_node(p->ast, AST_ERROR, @error)); }
| statement
;

property_name: NAME | MATERIAL | TEXTURE;

value:
  expression
| construct
;

construct:
  NAME block  { $$ = ast_holding(ast_named(p->ast, AST_CONSTRUCT, @$, $NAME, @NAME), $block); }
;

/* Literals first: most values are nothing else. */
expression:
  NUMBER       { $$ = parser_number(p, AST_NUMBER, @$, $1); }
| DEGREES      { $$ = parser_number(p, AST_ANGLE, @$, $1); }
| RADIANS      { $$ = parser_number(p, AST_ANGLE, @$, $1); $$->unit = AST_RADIANS; }
| STRING       { $$ = ast_text(p->ast, AST_STRING, @$, $1); }
| COLOUR       { $$ = parser_colour(p, @$, $1); }
| BAD_VALUE    { $$ = ast_node(p->ast, AST_ERROR, @$); }
| TRUE         { $$ = ast_node(p->ast, AST_BOOL, @$); $$->boolean = true; }
| FALSE        { $$ = ast_node(p->ast, AST_BOOL, @$); }
| NAME         { $$ = ast_named(p->ast, AST_NAME, @$, $1, @1); }
| NAME LPAREN arguments RPAREN
    { $$ = ast_holding(ast_named(p->ast, AST_CALL, @$, $NAME, @NAME), $arguments); }
| LPAREN value RPAREN                 { $$ = ast_with(ast_node(p->ast, AST_PARENTHESES, @$), $2); }
| LPAREN components[list] COMMA expression[last] RPAREN
    { $$ = ast_holding(ast_node(p->ast, AST_VECTOR, @$), ast_append($list, $last)); }
| LBRACKET values RBRACKET            { $$ = ast_holding(ast_node(p->ast, AST_LIST, @$), $values); }
| LBRACKET values COMMA RBRACKET      { $$ = ast_holding(ast_node(p->ast, AST_LIST, @$), $values); }
| LBRACKET RBRACKET                   { $$ = ast_node(p->ast, AST_LIST, @$); }
| LBRACKET value FOR NAME IN expression[sequence] RBRACKET
    { $$ = ast_holding(ast_named(p->ast, AST_COMPREHENSION, @$, $NAME, @NAME),
                       ast_pair($value, $sequence)); }
| expression[base] DOT NAME
    { $$ = ast_select(p->ast, @$, $base,
                      ast_named(p->ast, AST_MEMBER, span_join(@2, @NAME), $NAME, @NAME)); }
| expression[base] LBRACKET expression[index] RBRACKET[end]
    { $$ = ast_select(p->ast, @$, $base,
                      ast_with(ast_node(p->ast, AST_INDEX, span_join(@2, @end)), $index)); }
| expression OR expression             { $$ = ast_chain(p->ast, @$, $1, AST_OR, $3); }
| expression AND expression            { $$ = ast_chain(p->ast, @$, $1, AST_AND, $3); }
| expression EQUAL expression          { $$ = ast_chain(p->ast, @$, $1, AST_EQUAL, $3); }
| expression NOT_EQUAL expression      { $$ = ast_chain(p->ast, @$, $1, AST_NOT_EQUAL, $3); }
| expression LESS expression           { $$ = ast_chain(p->ast, @$, $1, AST_LESS, $3); }
| expression LESS_EQUAL expression     { $$ = ast_chain(p->ast, @$, $1, AST_LESS_EQUAL, $3); }
| expression GREATER expression        { $$ = ast_chain(p->ast, @$, $1, AST_GREATER, $3); }
| expression GREATER_EQUAL expression  { $$ = ast_chain(p->ast, @$, $1, AST_GREATER_EQUAL, $3); }
| expression PLUS expression           { $$ = ast_chain(p->ast, @$, $1, AST_ADD, $3); }
| expression MINUS expression          { $$ = ast_chain(p->ast, @$, $1, AST_SUBTRACT, $3); }
| expression STAR expression           { $$ = ast_chain(p->ast, @$, $1, AST_MULTIPLY, $3); }
| expression SLASH expression          { $$ = ast_chain(p->ast, @$, $1, AST_DIVIDE, $3); }
| expression PERCENT expression        { $$ = ast_chain(p->ast, @$, $1, AST_MODULO, $3); }
| expression CARET expression          { $$ = ast_chain(p->ast, @$, $1, AST_POWER, $3); }
| MINUS expression %prec SIGN          { $$ = ast_prefix(p->ast, @$, AST_NEGATE, $2); }
| PLUS expression %prec SIGN           { $$ = ast_prefix(p->ast, @$, AST_PLUS, $2); }
| NOT expression                       { $$ = ast_prefix(p->ast, @$, AST_NOT, $2); }
| expression QUESTION expression[yes] COLON expression[no]
    { $$ = ast_holding(ast_node(p->ast, AST_CONDITIONAL, @$), ast_append(ast_pair($1, $yes), $no)); }
;

components:
  expression                             { $$ = ast_append((struct ast_list){0}, $1); }
| components[list] COMMA expression      { $$ = ast_append($list, $3); }
;

values:
  value                                  { $$ = ast_append((struct ast_list){0}, $1); }
| values[list] COMMA value               { $$ = ast_append($list, $3); }
;

/* ---- XML ---- */

element:
  XML_OPEN attributes XML_EMPTY_END
    { $$ = xml_element(p, @$, $XML_OPEN, @XML_OPEN, $attributes, (struct xml_content){0}); }
| XML_OPEN attributes XML_TAG_END content XML_CLOSE
    { $$ = xml_element(p, @$, $XML_OPEN, @XML_OPEN, $attributes, $content); }
;

attributes:
  %empty                       { $$ = (struct ast_list){0}; }
| attributes[list] attribute   { $$ = ast_append($list, $attribute); }
| attributes[list] error       { $$ = $list; }
;

attribute:
  XML_ATTRIBUTE[name] XML_EQUALS XML_VALUE[text]
    { $$ = ast_with(ast_named(p->ast, AST_ATTRIBUTE, @$, $name, @name),
                    ast_text(p->ast, AST_TEXT, @text, $text)); }
;

content:
  %empty            { $$ = (struct xml_content){0}; }
| content XML_TEXT  { $$ = xml_add_text(p, $1, @2, $2); }
| content element   { $$ = $1; $$.children = ast_append($$.children, $2); }
;

%%

static int yyreport_syntax_error(const yypcontext_t *context, struct parser *p)
{
    yysymbol_kind_t expected[EXPECTED_MOST];
    const char *names[EXPECTED_MOST];
    int n = yypcontext_expected_tokens(context, expected, EXPECTED_MOST);
    if (n == YYENOMEM)
        return YYENOMEM;
    size_t said = 0;
    for (int i = 0; i < n; i++)
        if (expected[i] != YYSYMBOL_ORPHAN)
            names[said++] = yysymbol_name(expected[i]);
    yysymbol_kind_t found = yypcontext_token(context);
    parser_syntax_error(p, *yypcontext_location(context), yysymbol_name(found),
                        found == YYSYMBOL_YYEOF, names, said);
    return 0;
}

/* Only called when the stack is at its limit. */
static void scene_error(const struct span *span, struct parser *p, const char *message)
{
    (void)message;
    parser_stop(p, DIAG_TOO_DEEP, *span, "nested too deeply, so the rest is not read");
}
