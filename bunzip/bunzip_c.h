/* bunzip/bunzip_c.h -- the functions of bunzip.h for C and for languages that call C.
 *
 *   bunzip_workspace *workspace = bunzip_workspace_new();
 *   size_t made, taken;
 *   if (bunzip_decompress(workspace, in, in_bytes, out, out_bytes, &made, &taken) != BUNZIP_WHOLE)
 *       ...
 *   bunzip_workspace_free(workspace);
 *
 * The results, safety and memory are as in bunzip.h. No function throws. One thread at a time may
 * use a workspace.
 */
#ifndef STORMCELLAR_BUNZIP_C_H
#define STORMCELLAR_BUNZIP_C_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum bunzip_status {
    BUNZIP_WHOLE = 0,
    BUNZIP_TRUNCATED = 1, /* the bytes end inside the stream */
    BUNZIP_CORRUPT = 2,   /* the bytes contradict the format or a checksum */
    BUNZIP_TOO_LARGE = 3, /* the output is longer than `out` */
    BUNZIP_NO_MEMORY = 4  /* too little memory, or `workspace` is NULL */
};

typedef struct bunzip_workspace bunzip_workspace;

/* Returns an empty workspace, or NULL if memory is too little. The first use of the workspace takes
 * most of its memory. */
bunzip_workspace* bunzip_workspace_new(void);
/* Frees a workspace; does nothing with NULL. */
void bunzip_workspace_free(bunzip_workspace* workspace);

/* Decompresses one stream from `in` to `out`. Sets `*made` to the number of bytes written to `out`
 * and `*taken` to the number of bytes read from `in`; neither pointer may be NULL. The bytes are
 * the content of the stream if the result is BUNZIP_WHOLE, and its beginning if the result is
 * BUNZIP_TOO_LARGE; do not use them otherwise. `in` and `out` may be NULL if their size is 0. Bytes
 * of `out` after the first `*made` may change too. */
enum bunzip_status bunzip_decompress(bunzip_workspace* workspace, const void* in, size_t in_bytes,
                                     void* out, size_t out_bytes, size_t* made, size_t* taken);

/* Makes all threads use the path named "libbz2", "plain", "avx2" or "avx512" from now on. Returns
 * 1, or 0 without a change if this machine has no such path. */
int bunzip_use_path(const char* name);
/* Returns the name of the path in use. */
const char* bunzip_path(void);

#ifdef __cplusplus
}
#endif

#endif
