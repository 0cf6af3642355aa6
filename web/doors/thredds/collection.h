// web/doors/thredds/collection.h -- a data set of the THREDDS radar server. It has stations, and
// files by station and time with their bytes.
//
// Threads   Many threads may use one object.
// Errors    Those of RawFiles.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "web/config/web_config.h"
#include "web/data/raw/raw_files.h"
#include "web/http/answer.h"

namespace stormcellar::web {

struct ThreddsStation {
    std::string id;
    std::string name, state, country;
    bool has_place = false;  // true: the fields below are known
    double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;
};

struct ThreddsVariable {
    std::string name, units;
    std::string vocabulary_name;  // name in the vocabulary DIF
};

// Selects the files of a station. If the data set needs variables, selects the files of a station
// and a variable.
struct ThreddsSeries {
    std::string_view station, variable;
};

// A file. Its path is relative to the path of the data set, as in
// KTLX/20220317/KTLX20220317_000842_V06.
struct ThreddsFile {
    std::string name, path;
    UtcTime start{};
};

class ThreddsCollection {
  public:
    virtual ~ThreddsCollection() = default;
    ThreddsCollection(const ConfiguredCollection& configured, std::vector<ConfiguredPlace> places)
        : configured_(configured), places_(std::move(places)) {}

    [[nodiscard]] const std::string& path() const { return configured_.path; }
    [[nodiscard]] const std::string& title() const { return configured_.title; }
    // Returns "NEXRAD2" or "NIDS".
    [[nodiscard]] virtual std::string_view format() const = 0;
    [[nodiscard]] virtual std::string summary() const = 0;
    [[nodiscard]] virtual std::vector<ThreddsVariable> variables() const = 0;
    // Returns true if a query must name a variable, because each variable has its own files.
    [[nodiscard]] virtual bool needs_variable() const = 0;
    // Returns the configured stations, in their order. If none are configured, returns all stations
    // that have files.
    [[nodiscard]] Result<std::vector<ThreddsStation>> stations();
    // Returns the start of the oldest file, or none if there is no file. The result may be a minute
    // old.
    [[nodiscard]] virtual Result<std::optional<UtcTime>> oldest() = 0;

    // Returns the file that is nearest in time. Returns none if it is farther away than `within`.
    [[nodiscard]] virtual Result<std::optional<ThreddsFile>> nearest(
        ThreddsSeries series, UtcTime time, std::chrono::milliseconds within) = 0;
    // Returns files in ascending order of time.
    [[nodiscard]] virtual Result<std::vector<ThreddsFile>> list(ThreddsSeries series,
                                                                const RawRange& range) = 0;
    // Answers with the file at this path, which is given as segments.
    [[nodiscard]] virtual Answer file(const Request& request,
                                      std::span<const std::string_view> path) = 0;
    [[nodiscard]] virtual std::optional<Answer> file_at_once(
        const Request& /*request*/, std::span<const std::string_view> /*path*/) {
        return std::nullopt;
    }

  protected:
    [[nodiscard]] const ConfiguredCollection& configured() const { return configured_; }
    // Returns the identifiers of all stations that have files.
    [[nodiscard]] virtual Result<std::vector<std::string>> station_ids() = 0;
    // Returns the stations whose place is known from files, sorted by ICAO.
    [[nodiscard]] virtual std::vector<RawStation> placed_by_files() { return {}; }

  private:
    const ConfiguredCollection configured_;
    const std::vector<ConfiguredPlace> places_;
};

// Makes a data set: of Level III if the configuration has `variables`, else of the raw files.
// `places` take precedence over the station table.
[[nodiscard]] std::shared_ptr<ThreddsCollection> make_collection(
    const ConfiguredCollection& configured, const std::vector<ConfiguredPlace>& places,
    std::shared_ptr<RawFiles> files);

// Each of these functions makes one kind of data set. make_collection() chooses between them.
[[nodiscard]] std::shared_ptr<ThreddsCollection> make_level2_collection(
    const ConfiguredCollection& configured, const std::vector<ConfiguredPlace>& places,
    std::shared_ptr<RawFiles> files);
[[nodiscard]] std::shared_ptr<ThreddsCollection> make_level3_collection(
    const ConfiguredCollection& configured, const std::vector<ConfiguredPlace>& places);

}  // namespace stormcellar::web
