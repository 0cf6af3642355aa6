// The data set of Level II, whose files are the raw files.
#include <algorithm>

#include "base/steady_time.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/station_table.h"
#include "web/data/raw/raw_name.h"
#include "web/doors/raw/raw_answers.h"
#include "web/doors/thredds/collection.h"

namespace stormcellar::web {
namespace {

constexpr std::chrono::minutes oldest_holds_for{1};
constexpr std::size_t digits_of_day = 8;

ThreddsFile file_of(const RawVolume& volume) {
    const std::string day = format_compact(volume.start).substr(0, digits_of_day);
    return {volume.name, volume.station + '/' + day + '/' + volume.name, volume.start};
}

class Level2Collection final : public ThreddsCollection {
  public:
    Level2Collection(const ConfiguredCollection& configured,
                     const std::vector<ConfiguredPlace>& places, std::shared_ptr<RawFiles> files)
        : ThreddsCollection(configured, places), files_(std::move(files)) {}

    std::string_view format() const override { return "NEXRAD2"; }
    bool needs_variable() const override { return false; }
    std::string summary() const override {
        return "Volumes of NEXRAD Level II, as this server has received them.";
    }
    std::vector<ThreddsVariable> variables() const override;
    Result<std::optional<UtcTime>> oldest() override;
    Result<std::optional<ThreddsFile>> nearest(ThreddsSeries series, UtcTime time,
                                               std::chrono::milliseconds within) override;
    Result<std::vector<ThreddsFile>> list(ThreddsSeries series, const RawRange& range) override;
    Answer file(const Request& request, std::span<const std::string_view> path) override;
    std::optional<Answer> file_at_once(const Request& request,
                                       std::span<const std::string_view> path) override;

  protected:
    Result<std::vector<std::string>> station_ids() override;
    std::vector<RawStation> placed_by_files() override;

  private:
    // Returns true if the path is STATION/YYYYMMDD/NAME, for a station of this data set.
    [[nodiscard]] bool is_path(std::span<const std::string_view> path) const;
    [[nodiscard]] bool has_station(std::string_view id) const;

    const std::shared_ptr<RawFiles> files_;
    Mutex mutex_;
    std::optional<UtcTime> oldest_ STORMCELLAR_GUARDED_BY(mutex_);
    std::optional<std::chrono::steady_clock::time_point> found_oldest_
        STORMCELLAR_GUARDED_BY(mutex_);
};

// Returns the variables with the names that Unidata's server gives them, because clients compare
// these names.
std::vector<ThreddsVariable> Level2Collection::variables() const {
    const std::string radar = "EARTH SCIENCE > Spectral/Engineering > Radar >";
    return {{"CorrelationCoefficient", "dimensionless", radar},
            {"DifferentialPhase", "deg", radar},
            {"DifferentialReflectivity", "dB", radar},
            {"Reflectivity", "dBZ", radar + " Radar Reflectivity"},
            {"SpectrumWidth", "m/s", radar + " Doppler Spectrum Width"},
            {"Velocity", "m/s", radar + " Doppler Velocity"}};
}

bool Level2Collection::has_station(std::string_view id) const {
    const std::vector<std::string>& named = configured().stations;
    return named.empty() || std::ranges::count(named, id) > 0;
}

Result<std::vector<std::string>> Level2Collection::station_ids() {
    const auto stations = files_->stations();
    if (!stations) return pass_on(stations);
    std::vector<std::string> ids;
    for (const RawStation& station : *stations)
        ids.push_back(station.icao);
    return ids;
}

std::vector<RawStation> Level2Collection::placed_by_files() {
    auto stations = files_->stations();
    if (!stations) return {};
    std::erase_if(*stations, [](const RawStation& station) { return !station.has_place; });
    return *std::move(stations);
}

Result<std::optional<UtcTime>> Level2Collection::oldest() {
    const auto now = std::chrono::steady_clock::now();
    {
        const MutexLock lock(mutex_);
        if (found_oldest_ && now - *found_oldest_ < oldest_holds_for) return oldest_;
    }
    const auto all = stations();
    if (!all) return pass_on(all);
    std::optional<UtcTime> oldest;
    for (const ThreddsStation& station : *all) {
        RawRange first;
        first.most = 1;
        const auto volumes = files_->list(station.id, first);
        if (!volumes) return pass_on(volumes);
        if (volumes->empty()) continue;
        oldest = std::min(oldest.value_or(volumes->front().start), volumes->front().start);
    }
    const MutexLock lock(mutex_);
    oldest_ = oldest;
    found_oldest_ = now;
    return oldest;
}

Result<std::optional<ThreddsFile>> Level2Collection::nearest(ThreddsSeries series, UtcTime time,
                                                             std::chrono::milliseconds within) {
    if (!has_station(series.station)) return std::optional<ThreddsFile>{};
    const auto volume = files_->nearest(series.station, time, within);
    if (!volume) return pass_on(volume);
    return *volume ? std::optional{file_of(**volume)} : std::nullopt;
}

Result<std::vector<ThreddsFile>> Level2Collection::list(ThreddsSeries series,
                                                        const RawRange& range) {
    std::vector<ThreddsFile> files;
    if (!has_station(series.station)) return files;
    const auto volumes = files_->list(series.station, range);
    if (!volumes) return pass_on(volumes);
    files.reserve(volumes->size());
    for (const RawVolume& volume : *volumes)
        files.push_back(file_of(volume));
    return files;
}

bool Level2Collection::is_path(std::span<const std::string_view> path) const {
    if (path.size() != 3 || !has_station(path[0])) return false;
    const auto time = time_of_raw_name(path[0], path[2]);
    // A client may also give the name of the dropped file, with any day.
    return path[1].size() == digits_of_day && (!time || format_compact(*time).starts_with(path[1]));
}

Answer Level2Collection::file(const Request& request, std::span<const std::string_view> path) {
    if (!is_path(path)) return sentence(404, "There is no such volume.");
    return volume_answer(request, *files_, path[0], path[2]);
}

std::optional<Answer> Level2Collection::file_at_once(const Request& request,
                                                     std::span<const std::string_view> path) {
    if (!is_path(path)) return std::nullopt;
    return volume_answer_at_once(request, *files_, path[0], path[2]);
}

}  // namespace

std::shared_ptr<ThreddsCollection> make_level2_collection(
    const ConfiguredCollection& configured, const std::vector<ConfiguredPlace>& places,
    std::shared_ptr<RawFiles> files) {
    return std::make_shared<Level2Collection>(configured, places, std::move(files));
}

}  // namespace stormcellar::web
