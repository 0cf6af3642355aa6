// web/data/frame_pictures.h -- pictures as `stormcellar frame` draws them, of grids of the cache.
//
// A picture follows from the grids' bytes and the options alone: its times are in UTC unless a time
// zone is asked for, and it does not tell how old the data are. The same options of `stormcellar
// frame` give the same bytes.
//
// Threads   Many threads may use it. If several want the same picture at the same time, one draws
//           it. Who calls it bounds how many are drawn at once (web/http/work_queue.h).
// Errors    See each function.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/options/panel_scenes.h"
#include "render/options/scene_options.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/still.h"
#include "web/data/grids.h"
#include "web/data/kept_answers.h"
#include "web/http/request.h"

namespace stormcellar::web {

// Larger pictures would hold up all others.
inline constexpr std::int64_t most_frame_pixels = 3840 * 2160;
inline constexpr std::int64_t most_frame_samples = most_frame_pixels * 256;  // pixels times slices

// What a query asks for.
struct FrameStyle {
    render::SceneOptions options;
    std::vector<render::PanelScene> panels;  // one, or several in one picture
    bool has_panels = false;                 // asked for, though it may be of one moment
    const render::StillFormat* format = nullptr;
    render::TiffContent tiff = render::TiffContent::values;
    std::string key;  // all of it in one text
};

// Reads the query of a picture in the format of this name's ending. Its parameters are the options
// of `stormcellar frame` (web/data/picture_query.h), "panels" and "geotiff"; `others` are read by
// the door. Errors: not_found for an ending that no format has; bad_argument.
[[nodiscard]] Result<FrameStyle> frame_style(std::string_view file_name, const Fields& query,
                                             std::span<const std::string_view> others);

struct FramePicturesOptions {
    std::shared_ptr<KeptAnswers> kept = std::make_shared<KeptAnswers>(32'000'000);
    int threads = 1;  // of one picture
};

// A picture of grids of one domain and time, one for each panel.
struct FramePicture {
    std::string domain;
    std::vector<std::shared_ptr<const OpenGrid>> grids;
    FrameStyle style;

    [[nodiscard]] std::string key() const;
    [[nodiscard]] std::string etag() const;  // with its quotes
};

class FramePictures {
  public:
    explicit FramePictures(FramePicturesOptions options) : options_(std::move(options)) {}

    // Returns the picture if it is kept. Takes microseconds.
    [[nodiscard]] std::optional<Kept> find(const FramePicture& picture);
    // Errors: those of drawing.
    [[nodiscard]] Result<Kept> find_or_draw(const FramePicture& picture);

  private:
    [[nodiscard]] Result<Kept> draw(const FramePicture& picture) const;

    FramePicturesOptions options_;
};

}  // namespace stormcellar::web
