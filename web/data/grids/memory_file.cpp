#include "web/data/grids/memory_file.h"

#include <cstdint>
#include <memory>
#include <utility>

#include <sys/mman.h>
#include <unistd.h>

namespace stormcellar::web {

bool write_all(const Descriptor& file, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(file.number(), bytes.data(), bytes.size());
        if (count <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    return true;
}

Piece in_file(const Text& text) {
    const std::string& bytes = *text;
    if (bytes.size() >= least_in_memory_file) {
        auto file =
            std::make_shared<const Descriptor>(::memfd_create("stormcellar-web", MFD_CLOEXEC));
        if (file->is_open() && write_all(*file, std::as_bytes(std::span(bytes))))
            return FileSlice{std::move(file), 0, bytes.size(), bytes.size()};
    }
    return text;
}

}  // namespace stormcellar::web
