/* Texts to trees: places, trivia, values, recovery. */
#include "config.h"

#include "load.h"
#include "unit.h"

#include "syntax/syntax.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const kind_names[] = {
    [AST_ERROR] = "error",
    [AST_VERSION] = "version",
    [AST_MODEL] = "model",
    [AST_INCLUDE] = "include",
    [AST_LET] = "let",
    [AST_PARAM] = "param",
    [AST_MATERIAL] = "material",
    [AST_TEXTURE] = "texture",
    [AST_FN] = "fn",
    [AST_DEFINE] = "define",
    [AST_DEFAULT] = "default",
    [AST_ASSERT] = "assert",
    [AST_FOR] = "for",
    [AST_IF] = "if",
    [AST_USE] = "use",
    [AST_BLOCK] = "block",
    [AST_PROPERTY] = "property",
    [AST_ATTRIBUTE] = "attribute",
    [AST_BODY] = "body",
    [AST_LABEL] = "label",
    [AST_PARAMETER] = "parameter",
    [AST_ARGUMENT] = "argument",
    [AST_MEMBER] = "member",
    [AST_INDEX] = "index",
    [AST_NUMBER] = "number",
    [AST_ANGLE] = "angle",
    [AST_STRING] = "string",
    [AST_BOOL] = "bool",
    [AST_COLOUR] = "colour",
    [AST_NAME] = "name",
    [AST_VECTOR] = "vector",
    [AST_LIST] = "list",
    [AST_COMPREHENSION] = "comprehension",
    [AST_CONSTRUCT] = "construct",
    [AST_CALL] = "call",
    [AST_SELECT] = "select",
    [AST_PREFIX] = "prefix",
    [AST_CHAIN] = "chain",
    [AST_CONDITIONAL] = "conditional",
    [AST_PARENTHESES] = "parentheses",
    [AST_TEXT] = "text",
};

/* One line a node, in order, children deeper: what it is, its name, and the text at its place. */
static void write_nodes(FILE *out, const struct load *l, const struct ast_node *n, int depth,
                        struct arena *memory)
{
    for (; n; n = n->next) {
        struct str all = srcmap_text(&l->sources, n->span);
        struct str name = srcmap_text(&l->sources, n->name_span);
        fprintf(out, "%*s%s%s", depth, "", ast_operators[n->operator].text, kind_names[n->kind]);
        if (n->name.n) {
            ck_assert_msg(str_equal(n->name, name), "name '%.*s' lies at '%.*s'", STR_ARG(n->name),
                          STR_ARG(name));
            fprintf(out, " %.*s", STR_ARG(n->name));
        }
        if ((n->kind == AST_BLOCK || n->kind == AST_DEFAULT) && n->label.n)
            fprintf(out, " %.*s", STR_ARG(n->label));
        if (n->kind == AST_TEXT || n->kind == AST_STRING)
            fprintf(out, " \"%.*s\"", STR_ARG(n->text));
        fprintf(out, ": %.*s\n", STR_ARG(all));
        bool property = n->kind == AST_PROPERTY;
        write_nodes(out, l, property ? ast_value(n, memory) : n->children, depth + 1, memory);
    }
}

static char *tree_of(const struct load *l)
{
    char *text;
    size_t n;
    FILE *out = open_memstream(&text, &n);
    struct arena memory = {0};
    write_nodes(out, l, l->ast.statements, 0, &memory);
    arena_free(&memory);
    fclose(out);
    return text;
}

static const struct {
    const char *text, *tree;
} trees[] = {
    {"wrt 1\nmodel classic\n", "version: wrt 1\nmodel classic: model classic\n"},
    {"wrt 1 let a = -1.5e3; param b = \"x\\n\"",
     "version: wrt 1\n"
     "let a: let a = -1.5e3\n prefix: -1.5e3\n  -number: 1.5e3\n"
     "param b: param b = \"x\\n\"\n string \"x\n\": \"x\\n\"\n"},
    {"wrt 1 let v = ( 1 , (-2) , 3deg ) let l = [ a , true, #aabbcc, ]",
     "version: wrt 1\n"
     "let v: let v = ( 1 , (-2) , 3deg )\n vector: ( 1 , (-2) , 3deg )\n"
     "  number: 1\n  parentheses: (-2)\n   prefix: -2\n    -number: 2\n  angle: 3deg\n"
     "let l: let l = [ a , true, #aabbcc, ]\n list: [ a , true, #aabbcc, ]\n"
     "  name a: a\n  bool: true\n  colour: #aabbcc\n"},
    {"wrt 1 sphere ball { radius: 1, material : gold { texture: t } } // end\n",
     "version: wrt 1\n"
     "block sphere ball: sphere ball { radius: 1, material : gold { texture: t } }\n"
     " property radius: radius: 1\n  number: 1\n"
     " property material: material : gold { texture: t }\n"
     "  construct gold: gold { texture: t }\n"
     "   property texture: texture: t\n    name t: t\n"},
    {"wrt 1 include \"a\\tb\" fn f(a, b = 1,) = a fn g() = 1",
     "version: wrt 1\n"
     "include: include \"a\\tb\"\n string \"a\tb\": \"a\\tb\"\n"
     "fn f: fn f(a, b = 1,) = a\n parameter a: a\n parameter b: b = 1\n  number: 1\n"
     " name a: a\n"
     "fn g: fn g() = 1\n number: 1\n"},
    {"wrt 1 define d() { r: 1 } default light point { } assert a, \"m\" d() d(1, a = 2) { }",
     "version: wrt 1\n"
     "define d: define d() { r: 1 }\n body: { r: 1 }\n  property r: r: 1\n   number: 1\n"
     "default light point: default light point { }\n"
     "assert: assert a, \"m\"\n name a: a\n string \"m\": \"m\"\n"
     "use d: d()\n"
     "use d: d(1, a = 2) { }\n number: 1\n argument a: a = 2\n  number: 2\n body: { }\n"},
    {"wrt 1 for i in s { a() } if c { } else if d { } else { } if e { }",
     "version: wrt 1\n"
     "for i: for i in s { a() }\n name s: s\n body: { a() }\n  use a: a()\n"
     "if: if c { } else if d { } else { }\n name c: c\n body: { }\n"
     " if: if d { } else { }\n  name d: d\n  body: { }\n  body: { }\n"
     "if: if e { }\n name e: e\n body: { }\n"},
    {"1 + 2 - 3 * 4 ^ 5 ^ -6",
     "chain: 1 + 2 - 3 * 4 ^ 5 ^ -6\n number: 1\n +number: 2\n"
     " -chain: 3 * 4 ^ 5 ^ -6\n  number: 3\n"
     "  *chain: 4 ^ 5 ^ -6\n   number: 4\n   ^chain: 5 ^ -6\n    number: 5\n"
     "    ^prefix: -6\n     -number: 6\n"},
    {"-2 ^ 2 == 1 != !a",
     "chain: -2 ^ 2 == 1 != !a\n prefix: -2 ^ 2\n  -chain: 2 ^ 2\n   number: 2\n   ^number: 2\n"
     " ==number: 1\n !=prefix: !a\n  !name a: a\n"},
    {"a - (b - c) - d",
     "chain: a - (b - c) - d\n name a: a\n -parentheses: (b - c)\n  chain: b - c\n"
     "   name b: b\n   -name c: c\n -name d: d\n"},
    {"a < b && c || +d % 2",
     "chain: a < b && c || +d % 2\n chain: a < b && c\n  chain: a < b\n   name a: a\n   <name b: "
     "b\n"
     "  &&name c: c\n ||chain: +d % 2\n  prefix: +d\n   +name d: d\n  %number: 2\n"},
    {"a ? b : c ? d : -e",
     "conditional: a ? b : c ? d : -e\n name a: a\n name b: b\n"
     " conditional: c ? d : -e\n  name c: c\n  name d: d\n  prefix: -e\n   -name e: e\n"},
    {"-f(1, g { }, n = [x for x in s])[0].x ^ 2",
     "prefix: -f(1, g { }, n = [x for x in s])[0].x ^ 2\n"
     " -chain: f(1, g { }, n = [x for x in s])[0].x ^ 2\n"
     "  select: f(1, g { }, n = [x for x in s])[0].x\n"
     "   call f: f(1, g { }, n = [x for x in s])\n    number: 1\n    construct g: g { }\n"
     "    argument n: n = [x for x in s]\n     comprehension x: [x for x in s]\n"
     "      name x: x\n      name s: s\n"
     "   index: [0]\n    number: 0\n   member x: .x\n  ^number: 2\n"},
    {"(gold { })", "parentheses: (gold { })\n construct gold: gold { }\n"},
    {"wrt 1 material m = lambert {} texture t = image { file: \"\" } mesh{}",
     "version: wrt 1\n"
     "material m: material m = lambert {}\n construct lambert: lambert {}\n"
     "texture t: texture t = image { file: \"\" }\n"
     " construct image: image { file: \"\" }\n  property file: file: \"\"\n   string \"\": \"\"\n"
     "block mesh: mesh{}\n"},
    {"<s a='1' b = \"&lt;x\"><v> 1 2\n</v></s>",
     "block s: <s a='1' b = \"&lt;x\"><v> 1 2\n</v></s>\n"
     " attribute a: a='1'\n  text \"1\": '1'\n"
     " attribute b: b = \"&lt;x\"\n  text \"<x\": \"&lt;x\"\n"
     " property v: <v> 1 2\n</v>\n  text \"1 2\": 1 2\n"},
    {"<?xml version='1.0'?>\n<s><!-- c --><a>1<!-- c -->2</a>\n<b class='q'/></s>\n<!-- d -->",
     "block s: <s><!-- c --><a>1<!-- c -->2</a>\n<b class='q'/></s>\n"
     " property a: <a>1<!-- c -->2</a>\n  text \"12\": 1<!-- c -->2\n"
     " block b: <b class='q'/>\n  attribute class: class='q'\n   text \"q\": 'q'\n"},
    {"<s>\n some \n<a>x</a> more <![CDATA[ ]]]]> </s>",
     "block s: <s>\n some \n<a>x</a> more <![CDATA[ ]]]]> </s>\n"
     " property a: <a>x</a>\n  text \"x\": x\n"
     " text \"some\": some\n text \"more\": more\n text \"]]\": ]]\n"},
};

START_TEST(tree_of_text)
{
    struct load l;
    bool scene = strncmp(trees[_i].text, "wrt", 3) == 0 || *trees[_i].text == '<';
    if (scene) {
        ck_assert_msg(load_parse(&l, trees[_i].text), "%s", load_first(&l));
    } else {
        load_text(&l, "value", trees[_i].text);
        syntax_parse_value(&l.sources, l.source, &l.ast);
    }
    char *tree = tree_of(&l);
    ck_assert_str_eq(tree, trees[_i].tree);
    /* what the scanner changes in the text while it reads is put back */
    ck_assert(str_is((struct str){l.source->text, l.source->n}, trees[_i].text));
    free(tree);
    load_free(&l);
}
END_TEST

static const struct {
    const char *leaf, *text;
    bool exact;
} leaves[] = {
    {"<a>1 2</a>", "1 2", true},
    {"<a>\n\t1 2 \r\n</a>", "1 2", true},
    {"<a><![CDATA[1 2]]></a>", "1 2", true},
    {"<a>1<![CDATA[ & < ]]>2</a>", "1 & < 2", false},
    {"<a>&#49;&#x32;&lt;&gt;&amp;&quot;&apos;</a>", "12<>&\"'", false},
    {"<a>a]]b]c</a>", "a]]b]c", true},
    {"<a><![CDATA[]]]]><![CDATA[>]]></a>", "]]>", false},
    {"<a><![CDATA[]]]]]]]></a>", "]]]]]", true},
    {"<a> <!-- x --> 1 <?p?> </a>", "1", false},
    {"<a>caf&#xe9;&#x1F600;</a>", "caf\xc3\xa9\xf0\x9f\x98\x80", false},
    {"<a></a>", "", false},
    {"<a/>", "", false},
    {"<a> <![CDATA[ ]]> </a>", "", true},
    {"<a>-- > \" '</a>", "-- > \" '", true},
};

START_TEST(text_of_leaf)
{
    struct load l;
    ck_assert_msg(load_parse(&l, leaves[_i].leaf), "%s", load_first(&l));
    const struct ast_node *text = l.ast.statements->children;
    ck_assert_msg(str_is(text->text, leaves[_i].text), "'%.*s'", STR_ARG(text->text));
    if (text->exact)
        ck_assert(str_equal(text->text, srcmap_text(&l.sources, text->span)));
    ck_assert_int_eq(text->exact && text->text.n, leaves[_i].exact && text->text.n);
    load_free(&l);
}
END_TEST

static const struct {
    const char *text, *trivia; /* one a line: kind and text */
} comments[] = {
    {"// a\nwrt 1 /* b\n*/ // c", "0// a|1/* b\n*/|0// c|"},
    {"wrt 1\n\n\nlet a = /**/ 1 /***/ // ** / \n", "1/**/|1/***/|0// ** / |"},
    {"<?xml?>\n<!-- a --><s><!-- - -- ->--><?p x?></s><!---->",
     "2<?xml?>|1<!-- a -->|1<!-- - -- ->-->|2<?p x?>|1<!---->|"},
    {"wrt 1 let s = \"// no /* no\"", ""},
};

START_TEST(trivia_of_text)
{
    struct load l;
    char found[500] = "";
    ck_assert_msg(load_parse(&l, comments[_i].text), "%s", load_first(&l));
    for (size_t i = 0; i < l.ast.trivia.n; i++) {
        struct str text = srcmap_text(&l.sources, l.ast.trivia.at[i].span);
        size_t n = strlen(found);
        snprintf(found + n, sizeof found - n, "%u%.*s|", l.ast.trivia.at[i].kind, STR_ARG(text));
    }
    ck_assert_str_eq(found, comments[_i].trivia);
    load_free(&l);
}
END_TEST

/* What is found in wrong texts, as "code:text at its place" each, and how many statements stay. */
static const struct {
    const char *text, *findings;
    size_t statements;
} mistakes[] = {
    {"wrt 1 let = 1 let b = 2", "E010:=|", 3},
    {"wrt 1 let a = ) let b = 2", "E010:)|", 3},
    {"wrt 1 sphere { radius 1 } let b = 2", "E010:1|", 3},
    {"wrt 1 sphere { radius: } let b = 2", "E010:}|", 3},
    {"wrt 1 sphere { a: 1 ) b: 2 } let b = 2", "E010:)|", 3},
    {"wrt 1 ) ) ) let b = ) let c = 1", "E010:)|E010:)|", 3},
    {"wrt 1 let a = 1em let b = 2q", "E016:1em|E016:2q|", 3},
    {"wrt 1 let a = #12 let b = \"\\q\" let c = 1", "E016:#12|E014:\\q|", 4},
    {"wrt 1 let a = \"open\nlet b = 1", "E015:\"|", 3},
    {"wrt 1 let a = 1 /* open", "E015:/*|", 2},
    {"wrt 1 let a = $ 1", "E010:$|", 2},
    {"wrt 1 let a = \xe2\x82\xac 1", "E010:\xe2\x82\xac|", 2},
    {"wrt 2", "E120:2|", 1},
    {"model classic", "W101:|", 1},
    {"", "E002:|", 0},
    {" \n", "E002:|", 0},
    {"<a><b></a>", "E011:</a>|", 1},
    {"<a></b></a>", "E011:</b>|", 1},
    {"<a>&x;</a>", "E013:&x;|", 1},
    {"<a b='&x; & &#0;'/>", "E013:&x;|E013:&|E013:&#0;|", 1},
    {"<a", "E010:|", 1},
    {"<a b='", "E015:'|E011:|", 1},
    {"<a b", "E010:|", 1},
    {"<a b=></a>", "E010:>|", 1},
    {"<a><!DOCTYPE a></a>", "E012:<!DOCTYPE|", 0},
    {"<a/><b/>", "E010:<b|", 0},
};

START_TEST(recovery)
{
    struct load l;
    char found[500] = "";
    load_parse(&l, mistakes[_i].text);
    diag_sort(&l.diag);
    for (size_t i = 0; i < l.diag.entries.n; i++) {
        const struct diag_entry *e = l.diag.entries.at[i];
        size_t n = strlen(found);
        struct str text = srcmap_text(&l.sources, e->span);
        snprintf(found + n, sizeof found - n, "%s:%.*s|", diag_rules[e->code].code, STR_ARG(text));
    }
    ck_assert_msg(strcmp(found, mistakes[_i].findings) == 0, "%s: %s", mistakes[_i].text, found);
    ck_assert_msg(ast_count(l.ast.statements) == mistakes[_i].statements, "%s: %zu statements",
                  mistakes[_i].text, ast_count(l.ast.statements));
    load_free(&l);
}
END_TEST

static const struct {
    const char *text;
    enum ast_kind kind;
} defines[] = {
    {"1", AST_NUMBER},
    {"-1", AST_PREFIX},
    {"(1, 2)", AST_VECTOR},
    {"[1]", AST_LIST},
    {"gold", AST_NAME},
    {"\"a\"", AST_STRING},
    {"wood.png", AST_STRING},
    {"../1/wood.png", AST_STRING},
    {"a[wood.png]", AST_STRING},
    {"a.x", AST_SELECT},
    {"", AST_STRING},
    {"1 2", AST_STRING},
    {"2x", AST_STRING},
    {"a { b: 1 }", AST_CONSTRUCT},
    {"((((", AST_STRING},
    {"let", AST_STRING},
    {"#aabbcc", AST_COLOUR},
    {"<a/>", AST_STRING},
    {"1; 2", AST_STRING},
};

START_TEST(value_of_define)
{
    struct load l;
    load_text(&l, "-D", defines[_i].text);
    syntax_parse_value(&l.sources, l.source, &l.ast);
    ck_assert_int_eq(l.ast.statements->kind, defines[_i].kind);
    if (l.ast.statements->kind == AST_STRING && defines[_i].text[0] != '"')
        ck_assert(str_is(l.ast.statements->text, defines[_i].text));
    ck_assert_uint_eq(l.diag.entries.n, 0);
    load_free(&l);
}
END_TEST

static const struct {
    const char *text;
    size_t n;
    const char *decoded; /* NULL: refused */
    enum diag_code code;
    size_t offset;
#define BYTES(text) text, sizeof(text) - 1
} encodings[] = {
    {BYTES("plain"), "plain", 0, 0},
    {BYTES("\xef\xbb\xbfplain"), "plain", 0, 0},
    {BYTES("a\0b"), NULL, DIAG_NOT_TEXT, 1},
    {BYTES("caf\xe9"), NULL, DIAG_ENCODING, 3},
    {BYTES("\xff\xfe<\0"), NULL, DIAG_ENCODING, 0},
    {BYTES("\xfe\xff\0<"), NULL, DIAG_ENCODING, 0},
#define DECLARED(e) "<?xml version='1.0' encoding='" e "'?>"
    {BYTES(DECLARED("latin-1") "\xe9\xff"), DECLARED("latin-1") "\xc3\xa9\xc3\xbf", 0, 0},
    {BYTES(DECLARED("ISO-8859-1") "\xe9"), DECLARED("ISO-8859-1") "\xc3\xa9", 0, 0},
    {BYTES(DECLARED("utf-8") "\xc3\xa9"), DECLARED("utf-8") "\xc3\xa9", 0, 0},
    {BYTES(DECLARED("US-ASCII") "x"), DECLARED("US-ASCII") "x", 0, 0},
    {BYTES(DECLARED("koi8-r") "x"), NULL, DIAG_ENCODING, 30},
    {BYTES(" " DECLARED("koi8-r") "x"), " " DECLARED("koi8-r") "x", 0, 0},
    {BYTES("<?xml encoding"), "<?xml encoding", 0, 0},
    {BYTES("<?xml encoding='"), "<?xml encoding='", 0, 0},
    {BYTES("<?xml encoding='>"), "<?xml encoding='>", 0, 0},
};

START_TEST(decoding)
{
    size_t n = encodings[_i].n;
    char *text = mem_alloc(n + 2, 1);
    memcpy(text, encodings[_i].text, n);
    struct encoding_problem problem;
    bool marked, right = syntax_decode(&text, &n, &marked, &problem);
    struct buffer back = {0};
    ck_assert_int_eq(right, encodings[_i].decoded != NULL);
    if (right)
        ck_assert(str_is((struct str){text, n}, encodings[_i].decoded));
    else
        ck_assert(problem.code == encodings[_i].code && problem.offset == encodings[_i].offset);
    if (right) { /* and as it was */
        syntax_encode((struct str){text, n}, marked, &back);
        ck_assert(str_equal((struct str){back.at, back.n},
                            (struct str){encodings[_i].text, encodings[_i].n}));
    }
    buffer_free(&back);
    free(text);
}
END_TEST

/* What the declared encoding lacks is said by its number. */
START_TEST(encoding_again)
{
    static const struct {
        const char *text, *bytes;
    } rows[] = {
        {DECLARED("ISO-8859-1") "\xc3\xa9\xe2\x82\xac", DECLARED("ISO-8859-1") "\xe9&#8364;"},
        {DECLARED("US-ASCII") "\xc3\xa9\xf0\x9f\x98\x80", DECLARED("US-ASCII") "&#233;&#128512;"},
        {DECLARED("utf-8") "\xc3\xa9", DECLARED("utf-8") "\xc3\xa9"},
        {"\xc3\xa9", "\xc3\xa9"},
    };
    for (int i = 0; i < COUNT(rows); i++) {
        struct buffer out = {0};
        syntax_encode(str_of(rows[i].text), false, &out);
        ck_assert(str_is((struct str){out.at, out.n}, rows[i].bytes));
        buffer_free(&out);
    }
}
END_TEST

Suite *syntax_suite(void)
{
    Suite *s = suite_create("syntax");
    TCase *t = tcase_create("trees");
    tcase_add_loop_test(t, tree_of_text, 0, COUNT(trees));
    tcase_add_loop_test(t, text_of_leaf, 0, COUNT(leaves));
    tcase_add_loop_test(t, trivia_of_text, 0, COUNT(comments));
    suite_add_tcase(s, t);

    t = tcase_create("mistakes");
    tcase_add_loop_test(t, recovery, 0, COUNT(mistakes));
    tcase_add_loop_test(t, value_of_define, 0, COUNT(defines));
    tcase_add_loop_test(t, decoding, 0, COUNT(encodings));
    tcase_add_test(t, encoding_again);
    suite_add_tcase(s, t);
    return s;
}
