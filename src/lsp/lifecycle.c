/* From initialize to exit. */
#include "config.h"

#include "lsp/server.h"

/* What the client offers beside UTF-16, which every client has. */
static enum position_encoding choose_encoding(const json_t *capabilities)
{
    static const enum position_encoding preferred[] = {POSITION_UTF8, POSITION_UTF32};
    const json_t *general = json_object_get(capabilities, "general");
    const json_t *offered = json_object_get(general, "positionEncodings");
    for (size_t i = 0; i < sizeof preferred / sizeof *preferred; i++)
        for (size_t k = 0; k < json_array_size(offered); k++) {
            const char *name = json_string_value(json_array_get(offered, k));
            if (name && strcmp(name, position_encoding_names[preferred[i]]) == 0)
                return preferred[i];
        }
    return POSITION_UTF16;
}

static bool shows_related(const json_t *capabilities)
{
    const json_t *document = json_object_get(capabilities, "textDocument");
    const json_t *publishing = json_object_get(document, "publishDiagnostics");
    return json_is_true(json_object_get(publishing, "relatedInformation"));
}

static json_t *capabilities_of(const struct server *s)
{
    return json_pack("{s:s, s:{s:b, s:i, s:b}, s:b, s:{s:[s, s, s, s]}, s:b, s:b, s:b, s:b, "
                     "s:{s:[s, s]}, s:{s:b}}",
                     "positionEncoding", position_encoding_names[s->encoding], /* */
                     "textDocumentSync", "openClose", true, "change", 2, "save",
                     true,                  /* 2: parts of texts */
                     "hoverProvider", true, /* */
                     "completionProvider", "triggerCharacters", ":", " ", "<", "\"", /* */
                     "definitionProvider", true, "referencesProvider", true,
                     "documentSymbolProvider", true, "documentFormattingProvider", true,       /* */
                     "codeActionProvider", "codeActionKinds", "quickfix", "source.fixAll.wrt", /* */
                     "renameProvider", "prepareProvider", true);
}

json_t *lsp_initialize(struct server *s, const json_t *params)
{
    const json_t *capabilities = json_object_get(params, "capabilities");
    s->encoding = choose_encoding(capabilities);
    s->related = shows_related(capabilities);
    s->state = SERVER_RUNNING;
    return json_pack("{s:o, s:{s:s, s:s}}", "capabilities", capabilities_of(s), "serverInfo",
                     "name", "wrt", "version", PACKAGE_VERSION);
}

/* The client is ready; nothing waited for that. */
void lsp_initialized(struct server *s, const json_t *params)
{
    (void)s;
    (void)params;
}

json_t *lsp_shutdown(struct server *s, const json_t *params)
{
    (void)params;
    s->state = SERVER_SHUT_DOWN;
    return json_null();
}

void lsp_exit(struct server *s, const json_t *params)
{
    (void)params;
    s->status = s->state == SERVER_SHUT_DOWN ? DIAG_EXIT_OK : DIAG_EXIT_INPUT;
    s->state = SERVER_ENDED;
}

/* The request was marked while both still waited (see server.c), or it is answered already. */
void lsp_cancel(struct server *s, const json_t *params)
{
    (void)s;
    (void)params;
}
