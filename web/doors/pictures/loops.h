// web/doors/pictures/loops.h -- the animations that stormcellard keeps up to date
// (docs/web/pictures.md).
//
//   /loops               what there is, as JSON
//   /loops/NAME.webp     the newest animation of the loop NAME, in each format that it has
//
// stormcellard replaces a file as a whole, so an answer is one animation from its beginning to its
// end.
//
// Threads   Many threads may use it.
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "web/config/served_loops.h"
#include "web/http/door.h"

namespace stormcellar::web {

class LoopsDoor final : public Door {
  public:
    explicit LoopsDoor(std::vector<ServedLoop> loops) : loops_(std::move(loops)) {}
    Answer answer(const Request& request) override;

  private:
    [[nodiscard]] Answer index(const Request& request) const;
    // "NAME.webp".
    [[nodiscard]] std::optional<std::filesystem::path> file_named(std::string_view name) const;

    std::vector<ServedLoop> loops_;
};

}  // namespace stormcellar::web
