#include "config.h"

#include "lsp/document.h"

#include "base/file.h"
#include "lsp/analysis.h"
#include "lsp/uri.h"

#include <stdlib.h>

static void document_free(struct document *doc)
{
    analysis_free(doc->analysis);
    buffer_free(&doc->text);
    line_index_free(&doc->lines);
    free(doc->uri);
    free(doc->path);
    free(doc);
}

void documents_free(struct documents *d)
{
    for (size_t i = 0; i < d->list.n; i++)
        document_free(d->list.at[i]);
    vec_free(&d->list);
}

struct document *documents_find(const struct documents *d, const char *uri)
{
    for (size_t i = 0; i < d->list.n; i++)
        if (strcmp(d->list.at[i]->uri, uri) == 0)
            return d->list.at[i];
    return NULL;
}

struct document *documents_find_file(const struct documents *d, const char *path)
{
    struct file_id wanted, id;
    bool known = file_identify(path, &wanted);
    for (size_t i = 0; i < d->list.n; i++) {
        const char *other = d->list.at[i]->path;
        bool same = known && file_identify(other, &id) && id.device == wanted.device &&
                    id.inode == wanted.inode;
        if (same || strcmp(other, path) == 0)
            return d->list.at[i];
    }
    return NULL;
}

void document_changed(struct document *doc)
{
    analysis_free(doc->analysis);
    doc->analysis = NULL;
    doc->due = true;
    line_index_build(&doc->lines, (struct str){doc->text.at, doc->text.n});
}

struct document *documents_open(struct documents *d, const char *uri, struct str text)
{
    struct document *doc = documents_find(d, uri);
    if (!doc) {
        size_t n = strlen(uri) + 1;
        doc = mem_zalloc(1, sizeof *doc);
        doc->uri = memcpy(mem_alloc(n, 1), uri, n);
        doc->path = uri_to_path(uri);
        vec_push(&d->list, doc);
    }
    doc->text.n = 0;
    buffer_str(&doc->text, text);
    document_changed(doc);
    return doc;
}

void documents_close(struct documents *d, struct document *doc)
{
    size_t i = 0;
    while (d->list.at[i] != doc)
        i++;
    memmove(&d->list.at[i], &d->list.at[i + 1], (--d->list.n - i) * sizeof *d->list.at);
    document_free(doc);
}

void document_edit(struct document *doc, uint32_t begin, uint32_t end, struct str text)
{
    struct buffer whole = {0};
    buffer_add(&whole, doc->text.at, begin);
    buffer_str(&whole, text);
    buffer_add(&whole, doc->text.at + end, doc->text.n - end);
    buffer_free(&doc->text);
    doc->text = whole;
    document_changed(doc);
}
