// The raw files that somebody named, without a catalog.
#include <algorithm>
#include <map>
#include <set>

#include <fcntl.h>
#include <sys/stat.h>

#include "stormcellar/base/station_table.h"
#include "web/data/raw_files.h"
#include "web/data/raw_name.h"

namespace stormcellar::web {
namespace {

class GivenRawFiles final : public RawFiles {
  public:
    explicit GivenRawFiles(std::vector<GivenVolume> volumes) {
        for (GivenVolume& volume : volumes) {
            if (volume.paths.empty() || !is_icao(volume.station)) continue;
            const bool chunks = volume.paths.size() > 1;
            std::string name =
                raw_name(volume.station, volume.start,
                         chunks ? std::string{} : volume.paths.front().filename().string());
            stations_[volume.station].try_emplace(std::move(name), std::move(volume));
        }
    }

    Result<std::vector<RawStation>> stations() override;
    Result<std::vector<RawVolume>> list(std::string_view station, const RawRange& range) override;
    OpenedOrMissing open(std::string_view station, std::string_view name) override;
    std::optional<OpenedVolume> open_kept(std::string_view, std::string_view) override {
        return std::nullopt;
    }

  private:
    using ByName = std::map<std::string, GivenVolume, std::less<>>;
    static OpenedOrMissing open_given(const std::string& name, const GivenVolume& given);
    std::map<std::string, ByName, std::less<>> stations_;  // constant after construction
};

Result<std::vector<RawStation>> GivenRawFiles::stations() {
    std::vector<RawStation> stations;
    for (const auto& [icao, volumes] : stations_)
        stations.push_back(raw_station(icao, nullptr));
    return stations;
}

OpenedOrMissing GivenRawFiles::open_given(const std::string& name, const GivenVolume& given) {
    OpenedVolume opened;
    opened.volume.station = given.station;
    opened.volume.name = name;
    opened.volume.start = given.start;
    opened.volume.is_complete = given.is_complete;
    std::string tag;
    for (const std::filesystem::path& path : given.paths) {
        auto file = std::make_shared<const Descriptor>(
            ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
        struct stat facts {};
        if (!file->is_open() || ::fstat(file->number(), &facts) != 0) {
            return tl::unexpected(RawFailure{RawMissing::gone, path.native() + ": is deleted"});
        }
        if (!S_ISREG(facts.st_mode)) {
            return tl::unexpected(RawFailure{RawMissing::changed, path.native() + ": is no file"});
        }
        const auto size_bytes = static_cast<std::uint64_t>(facts.st_size);
        opened.volume.size_bytes += size_bytes;
        opened.volume.modified =
            std::max(opened.volume.modified,
                     UtcTime{std::chrono::seconds{facts.st_mtim.tv_sec} +
                             std::chrono::milliseconds{facts.st_mtim.tv_nsec / 1'000'000}});
        tag += fmt::format("-{:x}.{:x}.{:x}{:x}", facts.st_ino, size_bytes, facts.st_mtim.tv_sec,
                           facts.st_mtim.tv_nsec);
        if (size_bytes > 0) opened.bytes.emplace_back(FileSlice{std::move(file), 0, size_bytes});
    }
    // The names of a hundred chunks would make a long header.
    constexpr std::size_t longest_tag = 80;
    if (tag.size() > longest_tag) tag = fmt::format("-{:x}", std::hash<std::string>{}(tag));
    opened.volume.tag = fmt::format("\"f{}\"", tag);
    return opened;
}

Result<std::vector<RawVolume>> GivenRawFiles::list(std::string_view station,
                                                   const RawRange& range) {
    std::vector<RawVolume> volumes;
    const auto known = stations_.find(station);
    if (known == stations_.end()) return volumes;
    for (const auto& [name, given] : known->second) {
        if ((range.from && given.start < *range.from) || (range.to && given.start > *range.to)) {
            continue;
        }
        RawVolume volume;
        volume.station = given.station;
        volume.name = name;
        volume.start = given.start;
        volume.is_complete = given.is_complete;
        volumes.push_back(std::move(volume));
    }
    if (range.newest_first) std::ranges::reverse(volumes);
    if (volumes.size() > range.most) volumes.resize(range.most);
    if (!range.with_sizes) return volumes;
    std::erase_if(volumes, [&](RawVolume& volume) {
        auto opened = open_given(volume.name, known->second.find(volume.name)->second);
        if (opened) volume = std::move(opened->volume);
        return !opened;
    });
    return volumes;
}

OpenedOrMissing GivenRawFiles::open(std::string_view station, std::string_view name) {
    const auto known = stations_.find(station);
    if (known != stations_.end()) {
        for (const auto& [own, given] : known->second) {
            const bool is_of_volume = is_volume_name(station, name) && own.starts_with(name);
            const bool is_named =
                own == name || is_of_volume ||
                (given.paths.size() == 1 && given.paths.front().filename().native() == name);
            if (is_named) return open_given(own, given);
        }
    }
    return tl::unexpected(RawFailure{RawMissing::unknown, "no such volume"});
}

}  // namespace

std::shared_ptr<RawFiles> RawFiles::of_files(std::vector<GivenVolume> volumes) {
    return std::make_shared<GivenRawFiles>(std::move(volumes));
}

}  // namespace stormcellar::web
