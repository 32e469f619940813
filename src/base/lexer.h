/* Memory of flex scanners, which would print and exit on their own without it. */
#ifndef WRT_BASE_LEXER_H
#define WRT_BASE_LEXER_H

#include "base/mem.h"

#include <stdlib.h>

/* What a scanner with the options noyyalloc, noyyrealloc and noyyfree asks for. */
#define LEXER_MEMORY(prefix)                                                                       \
    void *prefix##alloc(yy_size_t n, yyscan_t scanner)                                             \
    {                                                                                              \
        (void)scanner;                                                                             \
        return mem_alloc(n, 1);                                                                    \
    }                                                                                              \
    void *prefix##realloc(void *p, yy_size_t n, yyscan_t scanner)                                  \
    {                                                                                              \
        (void)scanner;                                                                             \
        return mem_realloc(p, n, 1);                                                               \
    }                                                                                              \
    void prefix##free(void *p, yyscan_t scanner)                                                   \
    {                                                                                              \
        (void)scanner;                                                                             \
        free(p);                                                                                   \
    }

#endif
