// web/doors/pictures/loops.h -- sends the animations that stormcellard keeps up to date
// (docs/web/pictures.md).
//
//   /loops               the loops, as JSON or a page of links
//   /loops/NAME.webp     the newest animation of the loop NAME, in each format that it has
//
// stormcellard replaces each file as a whole, so an answer never mixes two animations.
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
    // Returns the file for a name such as "NAME.webp".
    [[nodiscard]] std::optional<std::filesystem::path> file_named(std::string_view name) const;

    std::vector<ServedLoop> loops_;
};

}  // namespace stormcellar::web
