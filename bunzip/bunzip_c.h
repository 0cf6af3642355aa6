/* bunzip/bunzip_c.h -- bunzip.h for C, and for whatever calls C.
 *
 *   bunzip_workspace *workspace = bunzip_workspace_new();
 *   size_t made, taken;
 *   if (bunzip_decompress(workspace, in, in_bytes, out, out_bytes, &made, &taken) != BUNZIP_WHOLE)
 *       ...
 *   bunzip_workspace_free(workspace);
 *
 * What bunzip.h promises holds here. No function throws. A workspace belongs to one thread at a
 * time.
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
    BUNZIP_CORRUPT = 2,   /* they contradict the format or a checksum */
    BUNZIP_TOO_LARGE = 3, /* `out` is full and the stream goes on */
    BUNZIP_NO_MEMORY = 4  /* or `workspace` is NULL, since there was none for it */
};

typedef struct bunzip_workspace bunzip_workspace;

/* NULL where there is no memory. It takes its memory when it is first used. */
bunzip_workspace* bunzip_workspace_new(void);
/* NULL is nothing. */
void bunzip_workspace_free(bunzip_workspace* workspace);

/* One stream. Both counts are always set: the bytes written to `out`, which are the stream's only
 * where the result is BUNZIP_WHOLE (or its first where it is BUNZIP_TOO_LARGE), and those of `in`
 * that it took; neither may be NULL. `in` and `out` may be NULL where their size is 0. What is in
 * `out` behind the bytes written may change. */
enum bunzip_status bunzip_decompress(bunzip_workspace* workspace, const void* in, size_t in_bytes,
                                     void* out, size_t out_bytes, size_t* made, size_t* taken);

/* "libbz2", "plain", "avx2" or "avx512": what is used from now on, by all threads. 0 where there is
 * no such path here, and then nothing is changed. */
int bunzip_use_path(const char* name);
/* That is used now. */
const char* bunzip_path(void);

#ifdef __cplusplus
}
#endif

#endif
