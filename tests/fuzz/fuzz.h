/* What is fuzzed: functions that take any bytes, and do with them what the program would. */
#ifndef WRT_TESTS_FUZZ_H
#define WRT_TESTS_FUZZ_H

#include "base/buffer.h"

#include <stddef.h>
#include <stdint.h>

void fuzz_scene(const uint8_t *data, size_t n); /* native or XML, as far as a small picture */
void fuzz_define(const uint8_t *data, size_t n);
void fuzz_mesh(const uint8_t *data, size_t n); /* the content tells the format */
void fuzz_uv_list(const uint8_t *data, size_t n);
void fuzz_wrl(const uint8_t *data, size_t n);
void fuzz_texture(const uint8_t *data, size_t n);
void fuzz_tiles(const uint8_t *data, size_t n);
void fuzz_frames(const uint8_t *data, size_t n);   /* what a client of the language server sends */
void fuzz_messages(const uint8_t *data, size_t n); /* the same, each line a message yet to be framed */

/* Words that a target's inputs are made of; each appends them, with NULs between. */
void words_native(struct buffer *out);
void words_xml(struct buffer *out);
void words_lsp(struct buffer *out);

/* A copy that scanners may write to, with room for two more bytes. */
char *fuzz_copy(const uint8_t *data, size_t n);

#endif
