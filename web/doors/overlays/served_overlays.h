// web/doors/overlays/served_overlays.h -- the overlays of the configuration as GeoJSON: shapes such
// as warnings, from files that other programs write.
//
// An overlay is a file of GeoJSON or a placefile (render/overlay/shape_file.h), or a directory of
// such files. The directory's files are read in the order of their names; names that begin with a
// dot, and directories in it, are left out. The text is made and compressed again when a file has
// changed.
//
// An overlay has at most a quarter of a million points, from at most 256 files; further files are
// left out.
//
// Each feature has a Point or a LineString, and the properties "stroke", "stroke-width", "name",
// "begin" and "end", as far as they are known. The collection's member "left_out" lists files that
// cannot be read, with the reason; the other files are served all the same.
//
// Threads   Many threads may use it. One makes the text of an overlay, and others that want the
//           same overlay wait.
// Errors    Those of compressed().
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"
#include "web/config/web_config.h"
#include "web/data/grids/compressed.h"
#include "web/http/answer.h"

namespace stormcellar::web {

// An overlay as it is sent.
struct SentOverlay {
    Text bytes;
    std::string etag;  // with quotes
    Coding coding;     // identity for a short text
};

class ServedOverlays {
  public:
    static constexpr std::size_t most_files = 256, most_points = 250'000;

    explicit ServedOverlays(const std::vector<ConfiguredOverlay>& overlays);

    [[nodiscard]] std::vector<std::string> names() const;
    // Returns the overlay of this name as GeoJSON; none if there is no such overlay.
    [[nodiscard]] std::optional<Result<SentOverlay>> geojson(std::string_view name,
                                                             Coding coding) const;

  private:
    struct Overlay {
        explicit Overlay(ConfiguredOverlay of) : configured(std::move(of)) {}
        const ConfiguredOverlay configured;
        Mutex mutex;
        std::string stamp STORMCELLAR_GUARDED_BY(mutex);  // names, sizes and times of the files
        std::array<Text, 3> texts STORMCELLAR_GUARDED_BY(mutex);  // by coding; null: not made
        std::string hash STORMCELLAR_GUARDED_BY(mutex);           // of the text, as hex digits
    };
    std::vector<std::unique_ptr<Overlay>> overlays_;
};

}  // namespace stormcellar::web
