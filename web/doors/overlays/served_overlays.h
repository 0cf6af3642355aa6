// web/doors/overlays/served_overlays.h -- the overlays of the configuration as GeoJSON: shapes such
// as warnings, from files that other programs write.
//
// An overlay is a file of GeoJSON or a placefile (render/overlay/shape_file.h), or a directory of
// such files. The directory's files are read in the order of their names; names that begin with a
// dot, and directories in it, are left out. The text is made again when a file has changed.
//
// Each feature has a Point or a LineString, and of these properties those that are known: "stroke",
// "stroke-width", "name", "begin" and "end". The collection's member "left_out" lists files that
// cannot be read, with the reason; the other files are served all the same.
//
// Threads   Many threads may use it. One makes the text of an overlay, and others that want it
// wait.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/mutex.h"
#include "web/config/web_config.h"
#include "web/http/answer.h"

namespace stormcellar::web {

class ServedOverlays {
  public:
    // The files of an overlay of a directory that are read; further ones are left out.
    static constexpr std::size_t most_files = 256;

    explicit ServedOverlays(std::vector<ConfiguredOverlay> overlays)
        : overlays_(std::move(overlays)) {}

    [[nodiscard]] const std::vector<ConfiguredOverlay>& overlays() const { return overlays_; }
    // Returns the overlay of this name as GeoJSON; none if there is no such overlay.
    [[nodiscard]] std::optional<Text> geojson(std::string_view name) const;

  private:
    struct Made {
        std::string stamp;  // names, sizes and times of the files
        Text text;
    };
    const std::vector<ConfiguredOverlay> overlays_;
    mutable Mutex mutex_;
    mutable std::map<std::string, Made, std::less<>> made_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::web
