// web/data/pictures/frame_pictures.h -- draws grids of the cache as `stormcellar frame` does.
//
// A picture depends only on the bytes of the grids and on the options. Its times are in UTC unless
// the query names a time zone, and it does not show the age of the data. `stormcellar frame` with
// the same options gives the same bytes.
//
// Threads   Many threads may use it. If several want the same picture at the same time, one draws
//           it. The caller limits how many are drawn at the same time (web/http/work_queue.h).
// Errors    See each function.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "web/data/grids/grids.h"
#include "web/data/grids/kept_answers.h"
#include "web/data/pictures/frame_style.h"

namespace stormcellar::web {

struct FramePicturesOptions {
    std::shared_ptr<KeptAnswers> kept = std::make_shared<KeptAnswers>(32'000'000);
    int threads = 1;                   // for one picture
    std::filesystem::path cache = {};  // which has the grids
};

// A picture of grids of one domain and time. Each panel shows one of the grids.
struct FramePicture {
    std::string domain;
    std::vector<std::shared_ptr<const OpenGrid>> grids;
    FrameStyle style;

    [[nodiscard]] std::string key() const;
    [[nodiscard]] std::string etag() const;  // with its quotes
};

// Returns the ETag, with its quotes, of the picture with this key. Another version of the program
// has another ETag.
[[nodiscard]] std::string etag_of_frame(const std::string& key);

class FramePictures {
  public:
    explicit FramePictures(FramePicturesOptions options) : options_(std::move(options)) {}

    // Returns the picture if it is kept. Takes microseconds.
    [[nodiscard]] std::optional<Kept> find(const FramePicture& picture);
    // Returns the picture. If it is not kept, draws it. Errors: those of drawing.
    [[nodiscard]] Result<Kept> find_or_draw(const FramePicture& picture);

  private:
    [[nodiscard]] Result<Kept> draw(const FramePicture& picture) const;

    FramePicturesOptions options_;
};

}  // namespace stormcellar::web
