#include <array>

#include "stormcellar/catalog/catalog.h"

namespace stormcellar::catalog {
namespace {

// The words, in the order of FileState. Never change a word, because the databases hold these
// words.
constexpr std::array<std::string_view, 5> names = {"seen", "complete", "partial", "rejected",
                                                   "gone"};

}  // namespace

std::string_view file_state_name(FileState state) {
    return names[static_cast<std::size_t>(state)];
}

std::optional<FileState> file_state_from_name(std::string_view name) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == name) return static_cast<FileState>(i);
    }
    return std::nullopt;
}

}  // namespace stormcellar::catalog
