/* Decompresses a bzip2 stream from stdin to stdout: a minimal C program that uses bunzip. */
#include <stdio.h>

#include "bunzip/bunzip_c.h"

static char in[1 << 16], out[1 << 20];

int main(void) {
    const size_t in_bytes = fread(in, 1, sizeof in, stdin);
    bunzip_workspace* workspace = bunzip_workspace_new();
    size_t made = 0, taken = 0;
    const enum bunzip_status status =
        bunzip_decompress(workspace, in, in_bytes, out, sizeof out, &made, &taken);
    bunzip_workspace_free(workspace);
    fwrite(out, 1, made, stdout);
    return (int)status;
}
