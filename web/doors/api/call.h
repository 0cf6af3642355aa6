// web/doors/api/call.h -- a request to the JSON API, and the code that the API's operations share.
//
// Threads   Many threads may use one ApiState. Each call is used by one thread.
// Errors    The functions that read a parameter return bad_argument with its name.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/recently_used.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/level2/volume.h"
#include "web/data/grids/compressed.h"
#include "web/data/grids/grids.h"
#include "web/data/grids/kept_answers.h"
#include "web/data/grids/region.h"
#include "web/data/raw/served_catalog.h"
#include "web/http/answer.h"

namespace stormcellar::web {

class EventFeed;
class StormAnswers;

using ApiJson = nlohmann::ordered_json;

inline constexpr std::string_view geojson_type = "application/geo+json";

// The data that the API serves.
struct ApiSources {
    std::shared_ptr<Grids> grids;   // null: no cache is served
    std::filesystem::path catalog;  // empty: no catalog is served
    // A reader of this catalog, if it is already open.
    std::shared_ptr<const catalog::CatalogReader> reader = nullptr;
    std::shared_ptr<KeptAnswers> kept;
    std::shared_ptr<const EventFeed> feed = nullptr;       // null: no station counts as silent
    bool gives_volumes = true;                             // raw files are served, too
    std::shared_ptr<const StormAnswers> storms = nullptr;  // null: no storms are served
};

class ApiState {
  public:
    explicit ApiState(ApiSources sources);
    [[nodiscard]] const ApiSources& sources() const { return sources_; }

    // Returns the catalog. Opens it at the first call, because it may appear late. Errors:
    // not_found if none is served; those of CatalogReader::open().
    [[nodiscard]] Result<ServedCatalog::Reader> catalog() { return catalog_.get(); }

    // A halved grid. The state keeps the most recently used halved grids.
    using Halved = std::shared_ptr<const grid::BrickGrid>;
    [[nodiscard]] Halved find_halved(const std::string& key);
    void keep_halved(const std::string& key, const Halved& halved);

    // A decoded volume. The state keeps the last volume, because clients request its sweeps one
    // after another.
    using DecodedVolume = std::shared_ptr<const level2::Volume>;
    [[nodiscard]] DecodedVolume find_volume(const std::string& key);
    void keep_volume(const std::string& key, DecodedVolume volume);

  private:
    const ApiSources sources_;
    ServedCatalog catalog_;
    Mutex mutex_;
    RecentlyUsed<std::string, Halved> halved_ STORMCELLAR_GUARDED_BY(mutex_);
    std::string volume_key_ STORMCELLAR_GUARDED_BY(mutex_);
    DecodedVolume volume_ STORMCELLAR_GUARDED_BY(mutex_);
};

struct ApiCall {
    const Request& request;
    ApiState& state;
    std::vector<std::pair<std::string, std::string>> path_values;
    // If true, an operation that would compute for long returns takes_long() instead. A worker for
    // long answers then calls it again with this member false.
    bool must_be_quick = false;

    [[nodiscard]] Grids& grids() const { return *state.sources().grids; }
    [[nodiscard]] std::string path_value(std::string_view name) const;
};

// Compresses an answer that will be kept. Its ETag is made from the coding and a hash of the
// uncompressed bytes.
[[nodiscard]] Result<Kept> kept_compressed(std::string_view bytes, Coding coding);
// Returns the entity of kept bytes, whose notes name their coding.
[[nodiscard]] Entity entity_of(const Kept& kept, std::string content_type);

// A value, or the answer that says what went wrong.
template <class T>
using Answered = tl::expected<T, Answer>;
[[nodiscard]] inline tl::unexpected<Answer> refuse(Answer answer) {
    return tl::unexpected<Answer>(std::move(answer));
}
[[nodiscard]] inline tl::unexpected<Answer> refuse(const Error& error) {
    return tl::unexpected<Answer>(json_error(error));
}

// Returns the kept value of a key. If it is not kept, makes and keeps it
// (KeptAnswers::find_or_make()), or answers takes_long() if the call must be quick.
[[nodiscard]] Answered<Kept> kept_or_made(const ApiCall& call, const std::string& key,
                                          const std::function<Result<Kept>()>& make);

// Each of these functions reads a parameter. If the parameter is absent, the function returns none
// or `usual`. A number must be finite and within its limits.
[[nodiscard]] Result<std::optional<double>> number_parameter(const ApiCall& call,
                                                             std::string_view name, double least,
                                                             double most);
[[nodiscard]] Result<std::int64_t> whole_parameter(const ApiCall& call, std::string_view name,
                                                   std::int64_t least, std::int64_t most,
                                                   std::int64_t usual);
[[nodiscard]] Result<std::optional<UtcTime>> time_parameter(const ApiCall& call,
                                                            std::string_view name);
[[nodiscard]] Result<std::optional<level2::Moment>> moment_parameter(const ApiCall& call);
// Reads west, south, east and north, all of which are required. If the box crosses the
// antimeridian, west is greater than east, or one of the two is beyond 180 degrees.
[[nodiscard]] Result<RegionBox> box_parameters(const ApiCall& call);
// The parameters `from`, `to` and `limit`. `limit` is the largest number of newest entries, from 1
// to 10,000, and 100 if it is absent.
struct ListedRange {
    std::optional<UtcTime> from, to;
    std::size_t limit = 0;
};
[[nodiscard]] Result<ListedRange> range_parameters(const ApiCall& call);
// Reads latitude and longitude in degrees, as in "35.3,-97.3". The parameter is required.
[[nodiscard]] Result<grid::GeoPoint> place_parameter(const ApiCall& call, std::string_view name);
// Reads a range such as "3-17" or "3". Both ends are included.
[[nodiscard]] Result<std::pair<std::size_t, std::size_t>> range_of_text(std::string_view name,
                                                                        std::string_view text);

// Finds the grid that {domain}, {moment} and {time} of the path name. {time} may be "latest". If
// that fails, the answer is 400 for a text that is not a time, 404 if there is no such grid, or 410
// if the grid was evicted; or it says why the grid cannot be read.
struct NamedGrid {
    std::string domain;
    level2::Moment moment = level2::Moment::ref;
    UtcTime time;
};
[[nodiscard]] Answered<NamedGrid> named_grid(const ApiCall& call);
[[nodiscard]] Answered<std::shared_ptr<const OpenGrid>> find_grid(const ApiCall& call);
// Finds the region that {region} and {moment} of the path name. If that fails, the answer is 400
// for a box that makes no sense, or 404 for an unknown moment or if no site with grids of the
// moment reaches the box; or it says why a grid cannot be read.
struct AskedRegion {
    std::string name;  // the box as the request writes it
    RegionPlan plan;
};
[[nodiscard]] Answered<AskedRegion> asked_region(const ApiCall& call);
// Answers a request for a grid that is not there.
[[nodiscard]] Answer missing_grid(Grids& grids, const NamedGrid& named);

// Answers with JSON. The client must revalidate each use, and gets 304 if the JSON has not changed.
[[nodiscard]] Answer json_answer(const Request& request, const ApiJson& document);
// Returns the answer by which an operation says that it would compute for long. The server never
// sends it.
[[nodiscard]] Answer takes_long();
// Returns the path of a grid in the API, for links.
[[nodiscard]] std::string grid_path(const NamedGrid& grid);

}  // namespace stormcellar::web
