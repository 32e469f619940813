/* One program for all targets.
 *
 *     fuzz TARGET FILE...          runs the target on each file: to look into a finding, and for AFL++
 *     fuzz --dictionary TARGET     the words of its inputs, as libFuzzer and AFL++ read them
 *     fuzz --list                  the targets
 *
 * Linked with libFuzzer (configure --enable-fuzzer), the variable WRT_FUZZ names the target, and the
 * command line is libFuzzer's. */
#include "config.h"

#include "fuzz.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/str.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct target {
    const char *name;
    void (*run)(const uint8_t *data, size_t n);
    void (*add_words)(struct buffer *out); /* those that are not in `words` */
    const char *words;                     /* with blanks between */
} targets[] = {
    {"native", fuzz_scene, words_native, ""},
    {"xml", fuzz_scene, words_xml, "<!-- --> <![CDATA[ ]]> <?xml ?> encoding= UTF-8 &amp; &#x"},
    {"define", fuzz_define, words_native, ""},
    {"off", fuzz_mesh, NULL, "OFF COFF NOFF STOFF 4OFF nOFF BINARY # 1e308 nan inf"},
    {"obj", fuzz_mesh, NULL, "v vt vn f vp o g s usemtl mtllib l p # \\\n // / -1 1e308 nan"},
    {"ply", fuzz_mesh, NULL,
     "ply format ascii binary_little_endian binary_big_endian 1.0 comment obj_info element vertex "
     "face property list char uchar short ushort int uint float double int8 uint8 int16 uint16 "
     "int32 uint32 float32 float64 vertex_indices vertex_index end_header x y z nx ny nz s t u v"},
    {"stl", fuzz_mesh, NULL, "solid facet normal outer loop vertex endloop endfacet endsolid"},
    {"uv", fuzz_uv_list, NULL, "1e308 nan inf 0.5 -1"},
    {"wrl", fuzz_wrl, NULL,
     "#VRML V2.0 utf8 DEF USE Group Shape Transform children geometry IndexedFaceSet coord "
     "Coordinate point coordIndex texCoord TextureCoordinate texCoordIndex PROTO EXTERNPROTO IS "
     "ROUTE TO Script field eventIn eventOut exposedField MFNode SFNode NULL TRUE FALSE [ ] { } -1"},
    {"png", fuzz_texture, NULL, "\x89PNG\r\n\x1a\n IHDR PLTE IDAT IEND tRNS gAMA sRGB zTXt iCCP"},
    {"jpeg", fuzz_texture, NULL,
     "\xff\xd8\xff \xff\xc0 \xff\xc2 \xff\xc4 \xff\xda \xff\xdb \xff\xdd \xff\xee \xff\xd9 JFIF"},
    {"tiles", fuzz_tiles, NULL, "wrt tiles 1 version scene settings stored part check plain little"},
    {"frames", fuzz_frames, words_lsp, "Content-Length: Content-Type: \r\n"},
    {"lsp", fuzz_messages, words_lsp, ""},
};
enum { TARGETS = sizeof targets / sizeof *targets };

static const struct target *find_target(const char *name)
{
    for (int i = 0; name && i < TARGETS; i++)
        if (strcmp(name, targets[i].name) == 0)
            return &targets[i];
    fprintf(stderr, "fuzz: no target is called '%s'; --list names them\n", name ? name : "");
    exit(2);
}

char *fuzz_copy(const uint8_t *data, size_t n)
{
    char *copy = mem_alloc(n + 2, 1);
    if (n)
        memcpy(copy, data, n);
    return copy;
}

static void *allocate(size_t n)
{
    return mem_alloc(n, 1);
}

#ifdef WITH_FUZZER

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t n);

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    (void)argc;
    (void)argv;
    find_target(getenv("WRT_FUZZ"));
    json_set_alloc_funcs(allocate, free);
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t n)
{
    find_target(getenv("WRT_FUZZ"))->run(data, n);
    return 0;
}

#else

static void run_file(const struct target *t, const char *path)
{
    char *data;
    size_t n;
    const char *reason = file_read(path, &data, &n);
    if (reason) {
        fprintf(stderr, "fuzz: could not read '%s': %s\n", path, reason);
        exit(3);
    }
    t->run((const uint8_t *)data, n);
    free(data);
}

/* name="word": everything but letters, digits and blanks as \xAB. */
static void print_word(struct str word)
{
    putchar('"');
    for (size_t i = 0; i < word.n; i++) {
        unsigned char c = (unsigned char)word.at[i];
        if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_')
            putchar(c);
        else
            printf("\\x%02X", c);
    }
    puts("\"");
}

static void print_words(const char *at, const char *end, char separator)
{
    while (at < end) {
        const char *stop = memchr(at, separator, (size_t)(end - at));
        stop = stop ? stop : end;
        if (stop > at)
            print_word((struct str){at, (size_t)(stop - at)});
        at = stop + 1;
    }
}

static int print_dictionary(const struct target *t)
{
    struct buffer words = {0};
    print_words(t->words, t->words + strlen(t->words), ' ');
    if (t->add_words)
        t->add_words(&words);
    print_words(words.at, words.at + words.n, 0);
    buffer_free(&words);
    return 0;
}

int main(int argc, char **argv)
{
    json_set_alloc_funcs(allocate, free);
    if (argc == 2 && strcmp(argv[1], "--list") == 0) {
        for (int i = 0; i < TARGETS; i++)
            puts(targets[i].name);
        return 0;
    }
    if (argc == 3 && strcmp(argv[1], "--dictionary") == 0)
        return print_dictionary(find_target(argv[2]));
    const struct target *t = find_target(argv[1]);
    for (int i = 2; i < argc; i++)
        run_file(t, argv[i]);
    return 0;
}

#endif
