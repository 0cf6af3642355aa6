#include "bunzip/bunzip_c.h"

#include <new>

#include "bunzip/bunzip.h"

using stormcellar::bunzip::Reader;
using stormcellar::bunzip::Status;

static_assert(static_cast<int>(Status::whole) == BUNZIP_WHOLE &&
              static_cast<int>(Status::truncated) == BUNZIP_TRUNCATED &&
              static_cast<int>(Status::corrupt) == BUNZIP_CORRUPT &&
              static_cast<int>(Status::too_large) == BUNZIP_TOO_LARGE);

struct bunzip_workspace {
    stormcellar::bunzip::Workspace workspace;
};

bunzip_workspace* bunzip_workspace_new() {
    return new (std::nothrow) bunzip_workspace;
}

void bunzip_workspace_free(bunzip_workspace* workspace) {
    delete workspace;
}

bunzip_status bunzip_decompress(bunzip_workspace* workspace, const void* in, std::size_t in_bytes,
                                void* out, std::size_t out_bytes, std::size_t* made,
                                std::size_t* taken) {
    *made = *taken = 0;
    if (workspace == nullptr) return BUNZIP_NO_MEMORY;
    try {
        Reader reader({static_cast<const std::byte*>(in), in_bytes}, workspace->workspace);
        // A reader without room reads nothing. So read one byte more to see if the output is longer
        // or the stream ends.
        std::byte surplus{};
        const std::span room{static_cast<std::byte*>(out), out_bytes};
        *made = reader.read(room);
        const bool longer = !reader.ended() && reader.read({&surplus, 1}) > 0;
        *taken = reader.input_bytes();
        return longer ? BUNZIP_TOO_LARGE : static_cast<bunzip_status>(reader.status());
    } catch (const std::bad_alloc&) {
        return BUNZIP_NO_MEMORY;
    }
}

int bunzip_use_path(const char* name) {
    if (name == nullptr) return 0;
    const auto path = stormcellar::bunzip::path_named(name);
    return path && stormcellar::bunzip::set_usual_path(*path) ? 1 : 0;
}

const char* bunzip_path() {
    return stormcellar::bunzip::name_of(stormcellar::bunzip::usual_path()).data();
}
