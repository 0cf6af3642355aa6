// A data set of Level III: the files of products in a directory. LDM configurations of Unidata give
// them names such as Level3_FTG_N0Q_20150615_1201.nids. The server does not read their contents.
#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>

#include "base/beneath.h"
#include "base/steady_time.h"
#include "stormcellar/base/mutex.h"
#include "web/doors/thredds/collection.h"
#include "web/doors/thredds/nearest_time.h"

namespace stormcellar::web {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds index_holds_for{10};
constexpr std::size_t most_products = 500'000;
constexpr std::string_view product_beginning = "Level3_", product_ending = ".nids";

bool is_product_word(std::string_view text) {
    return !text.empty() && text.size() <= 8 && std::ranges::all_of(text, [](char c) {
        return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    });
}

struct ProductName {
    std::string station, variable;
    UtcTime start{};
};

// Reads a name such as "Level3_FTG_N0Q_20150615_1201.nids".
std::optional<ProductName> product_of(std::string_view name) {
    if (!name.starts_with(product_beginning) || !name.ends_with(product_ending)) {
        return std::nullopt;
    }
    name.remove_prefix(product_beginning.size());
    name.remove_suffix(product_ending.size());
    const std::size_t behind_station = name.find('_');
    if (behind_station == name.npos) return std::nullopt;
    const std::size_t behind_variable = name.find('_', behind_station + 1);
    if (behind_variable == name.npos) return std::nullopt;
    ProductName product{
        std::string{name.substr(0, behind_station)},
        std::string{name.substr(behind_station + 1, behind_variable - behind_station - 1)},
        {}};
    const auto start = parse_compact(std::string{name.substr(behind_variable + 1)} + "00");
    if (!start || !is_product_word(product.station) || !is_product_word(product.variable)) {
        return std::nullopt;
    }
    product.start = *start;
    return product;
}

class Level3Collection final : public ThreddsCollection {
  public:
    using ThreddsCollection::ThreddsCollection;
    std::string_view format() const override { return "NIDS"; }
    bool needs_variable() const override { return true; }
    std::string summary() const override { return "Products of NEXRAD Level III."; }
    std::vector<ThreddsVariable> variables() const override;
    Result<std::optional<UtcTime>> oldest() override;
    Result<std::optional<ThreddsFile>> nearest(ThreddsSeries series, UtcTime time,
                                               std::chrono::milliseconds within) override;
    Result<std::vector<ThreddsFile>> list(ThreddsSeries series, const RawRange& range) override;
    Answer file(const Request& request, std::span<const std::string_view> path) override;

  protected:
    Result<std::vector<std::string>> station_ids() override;

  private:
    // Names of files by their times. The map cannot be copied, because a query may look up 10,000
    // times.
    struct Times : std::map<UtcTime, std::string> {
        Times() = default;
        Times(const Times&) = delete;
        Times& operator=(const Times&) = delete;
    };
    using Index = std::map<std::pair<std::string, std::string>, Times>;
    [[nodiscard]] Result<std::shared_ptr<const Index>> index();
    // Returns the times with their names. The result keeps the shared index alive.
    [[nodiscard]] Result<std::shared_ptr<const Times>> times_of(ThreddsSeries series);

    Mutex mutex_;
    std::shared_ptr<const Index> index_ STORMCELLAR_GUARDED_BY(mutex_);
    SteadyTime made_ STORMCELLAR_GUARDED_BY(mutex_){};
};

std::vector<ThreddsVariable> Level3Collection::variables() const {
    std::vector<ThreddsVariable> variables;
    for (const std::string& name : configured().variables)
        variables.push_back({name, {}, "EARTH SCIENCE > Spectral/Engineering > Radar >"});
    return variables;
}

Result<std::shared_ptr<const Level3Collection::Index>> Level3Collection::index() {
    const MutexLock lock(mutex_);
    if (index_ && steady_now() - made_ < index_holds_for) return index_;
    auto fresh = std::make_shared<Index>();
    if (!configured().files.empty()) {
        const auto names = names_beneath(configured().files, configured().files);
        if (!names) return pass_on(names);
        std::vector<std::pair<ProductName, const std::string*>> served;
        for (const std::string& name : *names) {
            auto product = product_of(name);
            if (product && std::ranges::count(configured().variables, product->variable) > 0)
                served.emplace_back(std::move(*product), &name);
        }
        // If there are too many products, serve only the newest.
        if (served.size() > most_products) {
            const auto newer = [](const auto& a, const auto& b) {
                return a.first.start > b.first.start;
            };
            std::ranges::nth_element(
                served, served.begin() + static_cast<std::ptrdiff_t>(most_products), newer);
            served.resize(most_products);
        }
        for (const auto& [product, name] : served)
            (*fresh)[{product.station, product.variable}].insert_or_assign(product.start, *name);
    }
    index_ = std::move(fresh);
    made_ = steady_now();
    return index_;
}

Result<std::vector<std::string>> Level3Collection::station_ids() {
    const auto known = index();
    if (!known) return pass_on(known);
    std::vector<std::string> ids;
    for (const auto& [key, times] : **known)
        if (ids.empty() || ids.back() != key.first) ids.push_back(key.first);
    return ids;
}

Result<std::shared_ptr<const Level3Collection::Times>> Level3Collection::times_of(
    ThreddsSeries series) {
    const auto known = index();
    if (!known) return pass_on(known);
    const std::vector<std::string>& named = configured().stations;
    const auto found = (*known)->find({std::string{series.station}, std::string{series.variable}});
    const bool is_named = named.empty() || std::ranges::count(named, series.station) > 0;
    if (found == (*known)->end() || !is_named) return std::make_shared<const Times>();
    return std::shared_ptr<const Times>(*known, &found->second);
}

Result<std::optional<UtcTime>> Level3Collection::oldest() {
    const auto known = index();
    if (!known) return pass_on(known);
    std::optional<UtcTime> oldest;
    for (const auto& [key, times] : **known)
        oldest = std::min(oldest.value_or(times.begin()->first), times.begin()->first);
    return oldest;
}

ThreddsFile product_file(ThreddsSeries series, const std::pair<const UtcTime, std::string>& file) {
    const auto& [start, name] = file;
    constexpr std::size_t digits = 8;
    return {name,
            fmt::format("{}/{}/{}/{}", series.variable, series.station,
                        format_compact(start).substr(0, digits), name),
            start};
}

Result<std::optional<ThreddsFile>> Level3Collection::nearest(ThreddsSeries series, UtcTime time,
                                                             std::chrono::milliseconds within) {
    const auto times = times_of(series);
    if (!times) return pass_on(times);
    const auto nearest = nearest_time(**times, time);
    if (nearest == (*times)->end() || std::chrono::abs(nearest->first - time) > within)
        return std::nullopt;
    return product_file(series, *nearest);
}

Result<std::vector<ThreddsFile>> Level3Collection::list(ThreddsSeries series,
                                                        const RawRange& range) {
    const auto times = times_of(series);
    if (!times) return pass_on(times);
    std::vector<ThreddsFile> files;
    auto at = range.from ? (*times)->lower_bound(*range.from) : (*times)->begin();
    for (; at != (*times)->end() && files.size() < range.most; ++at) {
        if (range.to && at->first > *range.to) break;
        files.push_back(product_file(series, *at));
    }
    return files;
}

// Serves only names that are in the index of the directory, so that no name can lead elsewhere.
Answer Level3Collection::file(const Request& request, std::span<const std::string_view> path) {
    const auto product = path.size() == 4 ? product_of(path[3]) : std::nullopt;
    if (!product || product->variable != path[0] || product->station != path[1]) {
        return sentence(404, "There is no such file.");
    }
    const auto times = times_of({product->station, product->variable});
    if (!times) return sentence(status_of(times.error()), "The files cannot be listed now.");
    const auto known = (*times)->find(product->start);
    if (known == (*times)->end() || known->second != path[3]) {
        return sentence(404, "There is no such file.");
    }
    const fs::path directory = configured().files;
    const auto opened = open_beneath(directory, directory / known->second);
    if (!opened && opened.error().code == ErrorCode::not_found)
        return sentence(410, "This file has been deleted.");
    if (!opened)
        return with_trouble(come_back(std::chrono::seconds{5}, "This file cannot be read now."),
                            opened.error());
    const auto file = std::make_shared<const Descriptor>(*opened);
    struct stat facts {};
    if (::fstat(file->number(), &facts) != 0) return sentence(500, "The file cannot be read.");
    Entity entity;
    const auto size = static_cast<std::uint64_t>(facts.st_size);
    if (size > 0) entity.bytes.emplace_back(FileSlice{file, 0, size});
    entity.content_type = "application/octet-stream";
    entity.etag = fmt::format("\"p{:x}-{:x}-{:x}.{:x}\"", facts.st_ino, size, facts.st_mtim.tv_sec,
                              facts.st_mtim.tv_nsec);
    entity.modified = UtcTime{std::chrono::seconds{facts.st_mtim.tv_sec}};
    return answer_with(request, std::move(entity));
}

}  // namespace

std::shared_ptr<ThreddsCollection> make_level3_collection(
    const ConfiguredCollection& configured, const std::vector<ConfiguredPlace>& places) {
    return std::make_shared<Level3Collection>(configured, places);
}

}  // namespace stormcellar::web
