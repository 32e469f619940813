/* The queue of messages, the life cycle, and which function answers what.
 *
 * One thread: before each message everything that has arrived is read, so that a request can still
 * be cancelled before it begins, and of many changes only the last is looked at. */
#include "config.h"

#include "lsp/server.h"

#include <stdarg.h>

/* Messages read ahead, and their bytes: what comes behind them waits in the pipe. */
enum { QUEUE_LIMIT = 1000, QUEUE_BYTES = TRANSPORT_MESSAGE_LIMIT };

static const struct method {
    const char *name;
    json_t *(*answer)(struct server *s, const json_t *params); /* of a request, or NULL */
    void (*take)(struct server *s, const json_t *params);      /* of a notification, or NULL */
} methods[] = {
#define REQUEST(name, function) {name, function, NULL},
#define NOTIFICATION(name, function) {name, NULL, function},
#include "lsp/methods.def"
};
enum { METHODS = sizeof methods / sizeof *methods };

static const struct method *find_method(const char *name)
{
    for (int i = 0; i < METHODS; i++)
        if (strcmp(methods[i].name, name) == 0)
            return &methods[i];
    return NULL;
}

/* ---- sending --------------------------------------------------------------------------------- */

static void end(struct server *s, int status)
{
    s->state = SERVER_ENDED;
    s->status = status;
}

/* Takes the message.  Where nobody listens there is nothing left to do. */
static void send_message(struct server *s, json_t *message)
{
    if (!message)
        mem_exhausted(0);
    json_object_set_new(message, "jsonrpc", json_string("2.0"));
    if (!transport_send(&s->transport, message))
        end(s, DIAG_EXIT_RESOURCE);
    json_decref(message);
}

void server_notify(struct server *s, const char *method, json_t *params)
{
    send_message(s, json_pack("{s:s, s:o}", "method", method, "params", params));
}

json_t *server_fail(struct server *s, enum rpc_code code, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(s->reason, sizeof s->reason, format, args);
    va_end(args);
    s->code = code;
    return NULL;
}

/* `id` NULL: the request's is not known. */
static void send_error(struct server *s, json_t *id, enum rpc_code code, const char *reason)
{
    json_t *text = json_string(reason);
    json_t *error = json_pack("{s:i, s:o}", "code", (int)code, "message",
                              text ? text : json_string("(a text cut within a character)"));
    send_message(s, json_pack("{s:O, s:o}", "id", id ? id : json_null(), "error", error));
}

/* ---- dispatch -------------------------------------------------------------------------------- */

/* Whether the state of the server lets a request pass. */
static bool is_due(struct server *s, const struct method *m)
{
    bool first = m && m->answer == lsp_initialize;
    if (s->state == SERVER_STARTING && !first)
        server_fail(s, RPC_NOT_INITIALIZED, "the first request must be 'initialize'");
    else if (s->state == SERVER_RUNNING && first)
        server_fail(s, RPC_INVALID_REQUEST, "'initialize' was requested before");
    else if (s->state == SERVER_SHUT_DOWN)
        server_fail(s, RPC_INVALID_REQUEST, "the server was shut down");
    else
        return true;
    return false;
}

static void answer(struct server *s, const struct message *message, const char *name, json_t *id)
{
    const struct method *m = find_method(name);
    const json_t *params = json_object_get(message->json, "params");
    json_t *result = NULL;
    if (message->cancelled)
        server_fail(s, RPC_CANCELLED, "cancelled");
    else if (!is_due(s, m))
        ;
    else if (!m || !m->answer)
        server_fail(s, RPC_METHOD_NOT_FOUND, "there is no request '%.100s'", name);
    else
        result = m->answer(s, params);
    if (result)
        send_message(s, json_pack("{s:O, s:o}", "id", id, "result", result));
    else
        send_error(s, id, s->code, s->reason);
}

/* Notifications have no answer, so what is wrong with them is passed over. */
static void take(struct server *s, const struct message *message, const char *name)
{
    const struct method *m = find_method(name);
    bool any_time = m && m->take == lsp_exit;
    if (m && m->take && (s->state == SERVER_RUNNING || any_time))
        m->take(s, json_object_get(message->json, "params"));
}

static void handle(struct server *s, const struct message *m)
{
    if (!m->json) {
        send_error(s, NULL, RPC_PARSE_ERROR, m->problem);
        return;
    }
    const char *name = json_string_value(json_object_get(m->json, "method"));
    json_t *id = json_object_get(m->json, "id");
    bool is_answer = json_object_get(m->json, "result") || json_object_get(m->json, "error");
    if (!name && is_answer)
        return;
    if (!name)
        send_error(s, id, RPC_INVALID_REQUEST, "the message is no request: it has no method");
    else if (id)
        answer(s, m, name, id);
    else
        take(s, m, name);
}

/* ---- the queue ------------------------------------------------------------------------------- */

static void enqueue(struct server *s, struct str body)
{
    struct message m = {.bytes = body.n};
    json_error_t error;
    m.json = json_loadb(body.at, body.n, JSON_DECODE_ANY, &error);
    if (!m.json)
        snprintf(m.problem, sizeof m.problem, "the message is no JSON: %s", error.text);
    s->bytes += m.bytes;
    vec_push(&s->queue, m);
}

static void enqueue_problem(struct server *s, const char *problem)
{
    struct message m = {0};
    snprintf(m.problem, sizeof m.problem, "%s", problem);
    vec_push(&s->queue, m);
}

static bool is_full(const struct server *s)
{
    return s->queue.n - s->head >= QUEUE_LIMIT || s->bytes >= QUEUE_BYTES;
}

/* Everything that was read becomes messages; returns how the rest stands. */
static enum transport_result take_messages(struct server *s, const char **problem)
{
    struct str body;
    enum transport_result result = TRANSPORT_NOTHING;
    while (!is_full(s)) {
        result = transport_take(&s->transport, &body, problem);
        if (result == TRANSPORT_MESSAGE)
            enqueue(s, body);
        else if (result == TRANSPORT_TOO_LARGE)
            enqueue_problem(s, "the message is too large, and was passed over");
        else
            break;
    }
    return result;
}

/* Reads ahead, and waits only for the first message. */
static enum transport_result fill(struct server *s, const char **problem)
{
    for (;;) {
        enum transport_result result = take_messages(s, problem);
        size_t waiting = s->queue.n - s->head;
        if (is_full(s) || result != TRANSPORT_NOTHING)
            return result;
        if (!transport_read(&s->transport, waiting == 0) && waiting)
            return result;
    }
}

static void cancel_queued(struct server *s)
{
    for (size_t i = s->head; i < s->queue.n; i++) {
        const json_t *m = s->queue.at[i].json;
        const char *name = json_string_value(json_object_get(m, "method"));
        const json_t *id = json_object_get(json_object_get(m, "params"), "id");
        if (!name || strcmp(name, "$/cancelRequest") != 0)
            continue;
        for (size_t k = s->head; k < i; k++)
            s->queue.at[k].cancelled |= json_equal(json_object_get(s->queue.at[k].json, "id"), id);
    }
}

static void pop(struct server *s)
{
    s->bytes -= s->queue.at[s->head].bytes;
    json_decref(s->queue.at[s->head].json);
    if (++s->head == s->queue.n)
        s->head = s->queue.n = 0;
}

/* Whether a message that waits will change the document again. */
static bool changes_soon(const struct server *s, const struct document *doc)
{
    for (size_t i = s->head; i < s->queue.n; i++) {
        const json_t *m = s->queue.at[i].json;
        const char *name = json_string_value(json_object_get(m, "method"));
        const json_t *params = json_object_get(m, "params");
        const char *uri =
            json_string_value(json_object_get(json_object_get(params, "textDocument"), "uri"));
        if (name && uri && strcmp(uri, doc->uri) == 0 &&
            (strcmp(name, "textDocument/didChange") == 0 ||
             strcmp(name, "textDocument/didClose") == 0))
            return true;
    }
    return false;
}

static void publish_due(struct server *s)
{
    for (size_t i = 0; i < s->documents.list.n; i++) {
        struct document *doc = s->documents.list.at[i];
        if (doc->due && s->state == SERVER_RUNNING && !changes_soon(s, doc))
            publish(s, doc);
    }
}

/* ---- the loop -------------------------------------------------------------------------------- */

static void handle_next(struct server *s)
{
    cancel_queued(s);
    struct message m = s->queue.at[s->head];
    json_incref(m.json);
    handle(s, &m);
    json_decref(m.json);
    pop(s);
    publish_due(s);
}

/* The input ended, or nobody knows where the next message begins. */
static void end_of_input(struct server *s, enum transport_result result, const char *problem,
                         struct buffer *out)
{
    if (result == TRANSPORT_BROKEN) {
        buffer_printf(out, "the client's messages cannot be read: %s", problem);
        send_error(s, NULL, RPC_PARSE_ERROR, problem);
    } else if (s->state != SERVER_SHUT_DOWN) {
        buffer_puts(out, "the client ended without 'shutdown' and 'exit'");
    }
    end(s,
        result == TRANSPORT_END && s->state == SERVER_SHUT_DOWN ? DIAG_EXIT_OK : DIAG_EXIT_INPUT);
}

int lsp_serve(int in, int out, const struct lsp_options *options, struct buffer *problem)
{
    struct server s = {.options = options};
    transport_init(&s.transport, in, out);
    while (s.state != SERVER_ENDED) {
        const char *why = NULL;
        enum transport_result result = fill(&s, &why);
        if (s.head < s.queue.n)
            handle_next(&s);
        else
            end_of_input(&s, result, why, problem);
    }
    if (s.transport.error) {
        problem->n = 0;
        buffer_printf(problem, "the client cannot be reached: %s", strerror(s.transport.error));
        s.status = DIAG_EXIT_RESOURCE;
    }
    while (s.head < s.queue.n)
        pop(&s);
    vec_free(&s.queue);
    documents_free(&s.documents);
    transport_free(&s.transport);
    return s.status;
}
