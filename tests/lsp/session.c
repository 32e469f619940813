/* Talks to a language server as a session file says, and writes the file anew with its answers.
 *
 *     session FILE.session PROGRAM [ARGUMENT...]    the session with what the program answers
 *
 * Lines of a session:
 *
 *     # anything           a comment
 *     | text               a line of the text that the next `open` sends
 *     open URI             textDocument/didOpen with the lines before it
 *     > {"id": 1, ...}     a message; "jsonrpc" is added
 *     + {"id": 1, ...}     likewise, sent together with the next one
 *     ! Content-Length...  bytes as they stand, with the escapes \r \n \\
 *     begin {...}          initialize with these capabilities, whose answer is not shown
 *     close                the end of the input
 *     end                  shutdown, exit and close
 *     < {...}              what the server sent: dropped when read, written anew
 *
 * A range is written "line:column-line:column".  After a request comes its answer, after a change
 * of a text what was found in it; after `close` everything up to the end, and the exit status. $dir
 * in a session is the folder the program runs in, as a URI. */
#include "config.h"

#include "base/buffer.h"
#include "base/file.h"
#include "lsp/transport.h"

#include <errno.h>
#include <jansson.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

struct session {
    struct transport server; /* `in` is what it writes */
    pid_t pid;
    struct buffer held, text; /* to be sent; of the next `open` */
    char *folder;             /* as a URI */
    json_int_t version;
};

static _Noreturn void fail(const char *what)
{
    fprintf(stderr, "session: %s: %s\n", what, strerror(errno));
    exit(2);
}

/* ---- the program ----------------------------------------------------------------------------- */

static void start(struct session *s, char **command)
{
    int to[2], from[2];
    if (pipe(to) || pipe(from))
        fail("pipe");
    s->pid = fork();
    if (s->pid == 0) {
        dup2(to[0], STDIN_FILENO);
        dup2(from[1], STDOUT_FILENO);
        dup2(STDOUT_FILENO, 3);
        close(to[0]), close(to[1]), close(from[0]), close(from[1]);
        execvp(command[0], command);
        fail(command[0]);
    }
    close(to[0]);
    close(from[1]);
    transport_init(&s->server, from[0], to[1]);
}

static void send_held(struct session *s)
{
    for (size_t at = 0; at < s->held.n;) {
        ssize_t n = write(s->server.out, s->held.at + at, s->held.n - at);
        if (n < 0)
            break; /* the server may have ended: its answers tell */
        at += (size_t)n;
    }
    s->held.n = 0;
}

static void hold(struct session *s, json_t *message)
{
    json_object_set_new(message, "jsonrpc", json_string("2.0"));
    char *text = json_dumps(message, JSON_COMPACT);
    buffer_printf(&s->held, "Content-Length: %zu\r\n\r\n", strlen(text));
    buffer_puts(&s->held, text);
    free(text);
}

/* ---- answers as readable text ---------------------------------------------------------------- */

/* A copy in which ranges are texts. */
static json_t *shorten(const json_t *j)
{
    json_int_t at[4];
    const char *key;
    json_t *value;
    size_t i;
    if (json_is_object(j) && json_object_size(j) == 2 &&
        json_unpack((json_t *)(uintptr_t)j, "{s:{s:I, s:I}, s:{s:I, s:I}}", "start", "line", &at[0],
                    "character", &at[1], "end", "line", &at[2], "character", &at[3]) == 0) {
        struct buffer text = {0};
        buffer_printf(&text, "%d:%d-%d:%d", (int)at[0], (int)at[1], (int)at[2], (int)at[3]);
        json_t *range = json_stringn(text.at, text.n);
        buffer_free(&text);
        return range;
    }
    json_t *copy = json_copy((json_t *)(uintptr_t)j);
    json_object_foreach(copy, key, value) json_object_set_new(copy, key, shorten(value));
    json_array_foreach(copy, i, value) json_array_set_new(copy, i, shorten(value));
    return copy;
}

/* On one line when that fits, else an item a line. */
static void print_json(struct buffer *out, const json_t *j, unsigned indent)
{
    enum { COLUMNS = 100 };
    char *flat = json_dumps(j, JSON_SORT_KEYS | JSON_ENCODE_ANY);
    size_t n = json_is_array(j) ? json_array_size(j) : json_object_size(j);
    bool object = json_is_object(j);
    if (strlen(flat) + indent <= COLUMNS || !n) {
        buffer_puts(out, flat);
        free(flat);
        return;
    }
    free(flat);
    json_t *keys = json_array(); /* sorted as jansson sorts them */
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)j, key, value)
    {
        size_t at = 0;
        while (at < json_array_size(keys) &&
               strcmp(json_string_value(json_array_get(keys, at)), key) < 0)
            at++;
        json_array_insert_new(keys, at, json_string(key));
    }
    buffer_puts(out, object ? "{" : "[");
    for (size_t i = 0; i < n; i++) {
        buffer_printf(out, "%s\n< ", i ? "," : "");
        buffer_fill(out, ' ', indent + 2);
        if (object)
            buffer_printf(out, "\"%s\": ", json_string_value(json_array_get(keys, i)));
        print_json(out,
                   object ? json_object_get(j, json_string_value(json_array_get(keys, i)))
                          : json_array_get(j, i),
                   indent + 2);
    }
    buffer_printf(out, "\n< ");
    buffer_fill(out, ' ', indent);
    buffer_puts(out, object ? "}" : "]");
    json_decref(keys);
}

static void replace_all(struct buffer *text, const char *old, const char *new)
{
    struct buffer out = {0};
    size_t n = strlen(old), at = 0;
    while (at < text->n) {
        const char *found = memmem(text->at + at, text->n - at, old, n);
        size_t before = found ? (size_t)(found - text->at) - at : text->n - at;
        buffer_add(&out, text->at + at, before);
        buffer_puts(&out, found ? new : "");
        at += before + (found ? n : 0);
    }
    buffer_free(text);
    *text = out;
}

static void print_message(const struct session *s, const json_t *j)
{
    struct buffer text = {0};
    json_t *shown = shorten(j);
    print_json(&text, shown, 0);
    json_decref(shown);
    replace_all(&text, s->folder, "$dir");
    replace_all(&text, s->folder + strlen("file://"), "$dir");
    replace_all(&text, PACKAGE_VERSION, "$version");
    printf("< %.*s\n", (int)text.n, text.at);
    buffer_free(&text);
}

/* The next message; NULL at the end. */
static json_t *receive(struct session *s, bool shown)
{
    struct str body;
    const char *problem = NULL;
    enum transport_result result;
    while ((result = transport_take(&s->server, &body, &problem)) == TRANSPORT_NOTHING)
        transport_read(&s->server, true);
    if (result != TRANSPORT_MESSAGE) {
        if (result != TRANSPORT_END)
            printf("< broken: %s\n", problem);
        return NULL;
    }
    json_t *j = json_loadb(body.at, body.n, 0, NULL);
    if (!j)
        fail("the answer is no JSON");
    json_object_del(j, "jsonrpc");
    if (shown)
        print_message(s, j);
    return j;
}

/* Receives up to the answer to a request, or what was found in a text. */
static void await(struct session *s, const json_t *message)
{
    const json_t *id = json_object_get(message, "id");
    const char *name = json_string_value(json_object_get(message, "method"));
    bool change = name && (strstr(name, "/didOpen") || strstr(name, "/didChange") ||
                           strstr(name, "/didClose") || strstr(name, "/didSave"));
    for (bool done = !id && !change; !done;) {
        json_t *j = receive(s, true);
        done = !j || (id ? json_equal(json_object_get(j, "id"), id)
                         : json_object_get(j, "method") != NULL);
        json_decref(j);
    }
}

/* ---- lines ----------------------------------------------------------------------------------- */

static json_t *read_message(const struct session *s, const char *line)
{
    struct buffer text = {0};
    json_error_t error;
    buffer_puts(&text, line);
    replace_all(&text, "$dir", s->folder);
    json_t *j = json_loadb(text.at, text.n, 0, &error);
    buffer_free(&text);
    if (j)
        return j;
    fprintf(stderr, "session: %s in: %s\n", error.text, line);
    exit(2);
}

static json_t *opening(struct session *s, const char *uri)
{
    struct buffer name = {0};
    buffer_puts(&name, uri);
    replace_all(&name, "$dir", s->folder);
    json_t *item =
        json_pack("{s:s%, s:s, s:I, s:s%}", "uri", name.at, name.n, "languageId", "wrt", "version",
                  ++s->version, "text", s->text.at ? s->text.at : "", s->text.n);
    buffer_free(&name);
    s->text.n = 0;
    return json_pack("{s:s, s:{s:o}}", "method", "textDocument/didOpen", "params", "textDocument",
                     item);
}

static void add_bytes(struct session *s, const char *p)
{
    for (; *p; p++) {
        char c = *p;
        if (c == '\\' && p[1])
            c = *++p == 'r' ? '\r' : *p == 'n' ? '\n' : *p;
        buffer_add(&s->held, &c, 1);
    }
}

static void finish(struct session *s)
{
    int status;
    close(s->server.out);
    for (json_t *j; (j = receive(s, true));)
        json_decref(j);
    waitpid(s->pid, &status, 0);
    if (WIFEXITED(status))
        printf("< exit status %d\n", WEXITSTATUS(status));
    else
        printf("< ended by signal %d\n", WTERMSIG(status));
}

static void begin(struct session *s, const char *capabilities)
{
    json_t *offered = read_message(s, *capabilities ? capabilities : "{}");
    json_t *j = json_pack("{s:i, s:s, s:{s:o}}", "id", 0, "method", "initialize", "params",
                          "capabilities", offered);
    hold(s, j);
    send_held(s);
    json_decref(j);
    json_decref(receive(s, false));
}

static void end(struct session *s)
{
    json_t *shutdown = json_pack("{s:i, s:s}", "id", 0, "method", "shutdown");
    json_t *exit = json_pack("{s:s}", "method", "exit");
    hold(s, shutdown);
    hold(s, exit);
    send_held(s);
    json_decref(receive(s, false));
    finish(s);
    json_decref(shutdown);
    json_decref(exit);
}

static void follow(struct session *s, const char *line)
{
    if (line[0] != '<')
        puts(line);
    if (strncmp(line, "| ", 2) == 0 || strcmp(line, "|") == 0)
        buffer_printf(&s->text, "%s\n", line[1] ? line + 2 : "");
    else if (strncmp(line, "! ", 2) == 0)
        add_bytes(s, line + 2);
    else if (strncmp(line, "begin", 5) == 0)
        begin(s, line + 5);
    else if (strcmp(line, "end") == 0)
        end(s);
    else if (strcmp(line, "close") == 0) {
        send_held(s);
        finish(s);
    } else if (strncmp(line, "open ", 5) == 0 || line[0] == '>' || line[0] == '+') {
        json_t *j = line[0] == 'o' ? opening(s, line + 5) : read_message(s, line + 1);
        hold(s, j);
        if (line[0] != '+') {
            send_held(s);
            await(s, j);
        }
        json_decref(j);
    } else if (line[0] && line[0] != '#' && line[0] != '<') {
        fprintf(stderr, "session: no such line: %s\n", line);
        exit(2);
    }
}

int main(int argc, char **argv)
{
    struct session s = {0};
    struct buffer uri = {0};
    char *text, *rest, *line;
    size_t n;
    if (argc < 3) {
        fputs("usage: session FILE.session PROGRAM [ARGUMENT...]\n", stderr);
        return 2;
    }
    const char *reason = file_read(argv[1], &text, &n);
    if (reason) {
        fprintf(stderr, "session: %s: %s\n", argv[1], reason);
        return 2;
    }
    char *folder = realpath(".", NULL);
    buffer_printf(&uri, "file://%s%c", folder, 0);
    s.folder = uri.at;
    signal(SIGPIPE, SIG_IGN);
    alarm(60); /* a server that never answers */
    start(&s, argv + 2);
    text[n] = 0;
    rest = text;
    while ((line = strsep(&rest, "\n")))
        if (*line || rest)
            follow(&s, line);
    transport_free(&s.server);
    buffer_free(&s.held);
    buffer_free(&s.text);
    buffer_free(&uri);
    free(folder);
    free(text);
    return 0;
}
