#include "web/data/pictures/frame_pictures.h"

#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/checksum.h"
#include "stormcellar/base/version.h"
#include "web/data/pictures/shown_grid.h"

namespace stormcellar::web {
namespace {

Status check_whole(const FramePicture& picture) {
    for (const auto& grid : picture.grids)
        if (Status whole = grid->file.check_whole(); !whole) return whole;
    return {};
}

}  // namespace

std::string FramePicture::key() const {
    std::string key = fmt::format("frame {}\n{}", domain, style.key);
    for (const auto& grid : grids)
        key += "\n" + grid->id;
    return key;
}

std::string FramePicture::etag() const {
    return etag_of_frame(key());
}

std::string etag_of_frame(const std::string& key) {
    const std::string all = fmt::format("{} {}", software_version, key);
    return fmt::format("\"{:016x}\"", xxh3_64(std::as_bytes(std::span(all))));
}

std::optional<Kept> FramePictures::find(const FramePicture& picture) {
    return options_.kept->find(picture.key());
}

Result<Kept> FramePictures::find_or_draw(const FramePicture& picture) {
    return options_.kept->find_or_make(picture.key(), [&] { return draw(picture); });
}

Result<Kept> FramePictures::draw(const FramePicture& picture) const {
    std::vector<ShownGrid> shown;
    for (std::size_t i = 0; i < picture.grids.size(); ++i) {
        auto one = shown_grid(options_.cache, *picture.grids[i], picture.style.panels[i].scene,
                              options_.threads);
        if (!one) return pass_on(one);
        shown.push_back(std::move(*one));
    }
    std::vector<DrawnPanel> panels;
    for (const ShownGrid& one : shown)
        panels.push_back({one.view(), &one.description()});
    auto drawn =
        draw_frame(picture.domain, picture.style, panels, picture.etag(), options_.threads);
    if (!drawn) return drawn;
    // If a file was truncated while we read it, missing codes read as 0 (not seen), so check that
    // the files are still whole.
    if (Status whole = check_whole(picture); !whole) return pass_on(whole);
    return drawn;
}

}  // namespace stormcellar::web
