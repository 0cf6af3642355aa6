#include "level2/foreign/odim.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "level2/foreign/quantity_names.h"

namespace stormcellar::level2 {
namespace {

using arrayfile::Array;
using arrayfile::Attributes;
using arrayfile::Group;

constexpr std::size_t most_rays = 20'000;

// The groups in which an attribute may be: those of a data set come before those of the file.
struct Place {
    std::vector<const Group*> groups;  // from the innermost out

    [[nodiscard]] const Attributes* attributes(std::string_view group,
                                               std::string_view name) const {
        for (const Group* one : groups) {
            const Group* found = one->group(group);
            if (found != nullptr && found->attributes.find(name) != nullptr)
                return &found->attributes;
        }
        return nullptr;
    }
    [[nodiscard]] std::optional<double> number(std::string_view group,
                                               std::string_view name) const {
        const Attributes* found = attributes(group, name);
        return found == nullptr ? std::nullopt : found->number(name);
    }
    [[nodiscard]] std::optional<std::string> text(std::string_view group,
                                                  std::string_view name) const {
        const Attributes* found = attributes(group, name);
        return found == nullptr ? std::nullopt : found->text(name);
    }
    [[nodiscard]] std::vector<double> numbers(std::string_view group, std::string_view name) const {
        const Attributes* found = attributes(group, name);
        return found == nullptr ? std::vector<double>{} : found->numbers(name);
    }
};

// Returns the groups whose names are the word and a number, in the order of the numbers.
std::vector<const Group*> numbered(const Group& in, std::string_view word) {
    std::map<int, const Group*> found;
    for (const Group& group : in.groups) {
        if (!group.name.starts_with(word)) continue;
        const char* end = group.name.data() + group.name.size();
        int number = 0;
        const auto parsed = std::from_chars(group.name.data() + word.size(), end, number);
        if (parsed.ec == std::errc{} && parsed.ptr == end) found.emplace(number, &group);
    }
    std::vector<const Group*> groups;
    for (const auto& [number, group] : found)
        groups.push_back(group);
    return groups;
}

// Returns the time of a date such as 20240131 and a time such as 123456.
std::optional<UtcTime> time_of(const Place& place, std::string_view date, std::string_view time) {
    const auto day = place.text("what", date), clock = place.text("what", time);
    if (!day || !clock || day->size() < 8 || clock->size() < 4) return std::nullopt;
    std::string seconds = clock->substr(0, 6);
    seconds.resize(6, '0');
    const auto parsed = parse_compact(day->substr(0, 8) + "_" + seconds);
    return parsed ? std::optional{*parsed} : std::nullopt;
}

std::optional<UtcTime> time_of_seconds(double seconds) {
    constexpr double last_second = 5.6e9;  // in the year 2147
    if (!(seconds > 0 && seconds < last_second)) return std::nullopt;
    return UtcTime{std::chrono::milliseconds{std::llround(seconds * 1000)}};
}

double normal_deg(double azimuth_deg) {
    const double turned = std::fmod(azimuth_deg, 360);
    return turned < 0 ? turned + 360 : turned;
}

// Returns the middle of two azimuths that are less than half a turn apart.
double middle_deg(double start_deg, double stop_deg) {
    double step = std::fmod(stop_deg - start_deg, 360);
    if (step > 180) step -= 360;
    if (step < -180) step += 360;
    return normal_deg(start_deg + step / 2);
}

// Returns the numbers of pairs such as "0.5:1.5,1.5:2.5" (how/azangles of version 2.0).
std::vector<double> numbers_of_pairs(const std::string& text) {
    std::vector<double> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at < end) {
        double number = 0;
        const auto parsed = std::from_chars(at, end, number);
        if (parsed.ec != std::errc{}) break;
        numbers.push_back(number);
        at = parsed.ptr + (parsed.ptr < end ? 1 : 0);
    }
    return numbers;
}

std::vector<double> azimuths_of(const Place& place, std::size_t rays) {
    std::vector<double> starts = place.numbers("how", "startazA");
    std::vector<double> stops = place.numbers("how", "stopazA");
    if (const auto pairs = place.text("how", "azangles"); starts.empty() && pairs) {
        const std::vector<double> numbers = numbers_of_pairs(*pairs);
        for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
            starts.push_back(numbers[i]);
            stops.push_back(numbers[i + 1]);
        }
    }
    std::vector<double> azimuths_deg;
    const double width_deg = 360 / static_cast<double>(rays);
    const double first_deg = place.number("how", "astart").value_or(0);
    for (std::size_t i = 0; i < rays; ++i) {
        const auto ray = static_cast<double>(i);
        if (starts.size() == rays && stops.size() == rays)
            azimuths_deg.push_back(middle_deg(starts[i], stops[i]));
        else if (starts.size() == rays)
            azimuths_deg.push_back(normal_deg(starts[i] + width_deg / 2));
        else
            azimuths_deg.push_back(normal_deg(first_deg + (ray + 0.5) * width_deg));
    }
    return azimuths_deg;
}

std::vector<double> elevations_of(const Place& place, std::size_t rays, double fixed_deg) {
    std::vector<double> all = place.numbers("how", "elangles");
    const std::vector<double> starts = place.numbers("how", "startelA");
    const std::vector<double> stops = place.numbers("how", "stopelA");
    if (all.size() != rays && starts.size() == rays && stops.size() == rays) {
        all.clear();
        for (std::size_t i = 0; i < rays; ++i)
            all.push_back((starts[i] + stops[i]) / 2);
    }
    if (all.size() != rays ||
        std::ranges::any_of(all, [](double e) { return !(std::abs(e) <= 90); }))
        all.assign(rays, fixed_deg);
    return all;
}

// Returns the number of the ray that was measured first.
std::size_t first_ray_of(const Place& place, std::size_t rays) {
    const double ray = place.number("where", "a1gate").value_or(0);
    return ray > 0 && ray < static_cast<double>(rays) ? static_cast<std::size_t>(ray) : 0;
}

// Returns a time for each ray. Without times of rays, spreads the time of the sweep over them,
// beginning with the ray that was measured first.
std::vector<UtcTime> times_of(const Place& place, std::size_t rays) {
    const auto starts = place.numbers("how", "startazT"), stops = place.numbers("how", "stopazT");
    std::vector<UtcTime> times;
    for (std::size_t i = 0; starts.size() == rays && i < rays; ++i) {
        const double middle = stops.size() == rays ? (starts[i] + stops[i]) / 2 : starts[i];
        if (const auto time = time_of_seconds(middle)) times.push_back(*time);
    }
    if (times.size() == rays) return times;
    auto start = time_of(place, "startdate", "starttime");
    if (!start) start = time_of(place, "date", "time");
    const UtcTime first = start.value_or(UtcTime{});
    const UtcTime last = std::max(first, time_of(place, "enddate", "endtime").value_or(first));
    constexpr std::chrono::hours longest_sweep{1};
    const auto length = std::min<std::chrono::milliseconds>(last - first, longest_sweep);
    const std::size_t turned = first_ray_of(place, rays);
    times.clear();
    for (std::size_t i = 0; i < rays; ++i) {
        const auto place_in_turn = static_cast<std::int64_t>((i + rays - turned) % rays);
        times.push_back(first + length * place_in_turn / static_cast<std::int64_t>(rays));
    }
    return times;
}

// Returns the Nyquist velocity, or 0. Without NI, two pulse rates (dual PRF) extend it.
double nyquist_of(const Place& place) {
    if (const auto given = place.number("how", "NI"); given && *given > 0 && *given < 1000)
        return *given;
    const double wavelength_m = place.number("how", "wavelength").value_or(0) / 100;
    const double high = place.number("how", "highprf").value_or(0);
    const double low = place.number("how", "lowprf").value_or(high);
    if (!(wavelength_m > 0 && wavelength_m < 1 && high > 0 && low > 0 && high < 1e5)) return 0;
    return wavelength_m / 4 * (high > low ? high * low / (high - low) : high);
}

std::vector<double> marks_of(const Place& place, std::string_view name) {
    const auto mark = place.number("what", name);
    return mark ? std::vector<double>{*mark} : std::vector<double>{};
}

struct NamedSource {
    Quantity quantity;
    std::string name;
    MomentSource source;
};

// Returns the meters in the unit of where/rstart: kilometers before version 2.4, then meters.
double meters_of_start(const Group& root) {
    const std::string conventions = root.attributes.text("Conventions").value_or("");
    const std::size_t at = conventions.find("V2_");
    const bool is_new = at != std::string::npos && at + 3 < conventions.size() &&
                        conventions[at + 3] >= '4' && conventions[at + 3] <= '9';
    return is_new ? 1 : 1000;
}

// Reads where the gates of one quantity are. Returns none if `data` holds none.
std::optional<NamedSource> source_of(const Group& data, const Place& place, PolarFile& file) {
    const Array* array = data.array("data");
    const auto name = place.text("what", "quantity");
    if (array == nullptr || !name || array->shape.size() != 2) return std::nullopt;
    const auto quantity = quantity_named(*name);
    if (!quantity) {
        file.left_out.push_back(*name);
        return std::nullopt;
    }
    NamedSource made{*quantity, *name, {}};
    MomentSource& source = made.source;
    source.moment = quantity->moment;
    source.array = array;
    source.gain = place.number("what", "gain").value_or(1);
    source.offset = place.number("what", "offset").value_or(0);
    source.missing = marks_of(place, "nodata");
    source.below = marks_of(place, "undetect");
    source.gate_spacing_m = place.number("where", "rscale").value_or(0);
    source.first_gate_m =
        place.number("where", "rstart").value_or(0) * meters_of_start(*place.groups.back()) +
        source.gate_spacing_m / 2;
    return made;
}

// Returns the quantities of a sweep. If several are for one moment, returns only the best.
std::vector<NamedSource> sources_of(const Group& root, const Group& dataset, PolarFile& file) {
    std::vector<NamedSource> best;
    for (const Group* data : numbered(dataset, "data")) {
        auto found = source_of(*data, Place{{data, &dataset, &root}}, file);
        if (!found) continue;
        const auto same = std::ranges::find_if(best, [&](const NamedSource& one) {
            return one.quantity.moment == found->quantity.moment;
        });
        if (same == best.end()) {
            best.push_back(std::move(*found));
        } else {
            if (found->quantity.rank < same->quantity.rank) std::swap(*found, *same);
            file.left_out.push_back(found->name);
        }
    }
    return best;
}

std::optional<PolarSweep> sweep_of(const Group& root, const Group& dataset, PolarFile& file) {
    const Place place{{&dataset, &root}};
    const auto elevation_deg = place.number("where", "elangle");
    if (!elevation_deg || !(std::abs(*elevation_deg) <= 90)) return std::nullopt;
    auto sources = sources_of(root, dataset, file);
    if (sources.empty()) return std::nullopt;
    const Array& first = *sources.front().source.array;
    const std::uint64_t rays = first.shape[0], gates = first.shape[1];
    if (rays == 0 || rays > most_rays || gates == 0 || gates > ~std::uint32_t{0})
        return std::nullopt;
    const auto count = static_cast<std::size_t>(rays);
    const auto azimuths_deg = azimuths_of(place, count);
    const auto elevations_deg = elevations_of(place, count, *elevation_deg);
    const auto times = times_of(place, count);
    const double nyquist_mps = nyquist_of(place);
    // This program's files have the velocities of all rays where they differ.
    auto nyquists_mps = place.numbers("how", "nyquist_velocities");
    const auto is_odd = [](double mps) { return !(mps >= 0 && mps < 1000); };
    if (nyquists_mps.size() != count || std::ranges::any_of(nyquists_mps, is_odd))
        nyquists_mps.assign(count, nyquist_mps);
    // Rays are in the order of azimuth; radials are in the order of time. Clocks may be coarse, so
    // rays of the same time stay in the order in which the antenna turns.
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto first_ray = static_cast<std::ptrdiff_t>(first_ray_of(place, count));
    std::rotate(order.begin(), order.begin() + first_ray, order.end());
    std::ranges::stable_sort(order, {}, [&](std::size_t ray) { return times[ray]; });
    PolarSweep made;
    made.sweep.vcp_elevation_deg = static_cast<float>(*elevation_deg);
    const double cut = place.number("how", "elevation_number").value_or(0);
    if (cut >= 1 && cut <= 255) made.sweep.elevation_number = static_cast<int>(cut);
    for (const std::size_t ray : order) {
        Radial& radial = made.sweep.radials.emplace_back();
        radial.time = times[ray];
        radial.azimuth_deg = static_cast<float>(azimuths_deg[ray]);
        radial.elevation_deg = static_cast<float>(elevations_deg[ray]);
        radial.nyquist_mps = static_cast<float>(nyquists_mps[ray]);
    }
    for (NamedSource& one : sources) {
        if (one.source.array->shape != first.shape) {
            file.left_out.push_back(one.name);
            continue;
        }
        for (const std::size_t ray : order)
            one.source.rows.push_back(
                {ray * static_cast<std::size_t>(gates), static_cast<std::uint32_t>(gates)});
        made.sources.push_back(std::move(one.source));
    }
    return made;
}

// Returns true if both have the same radials. Moments whose gates differ are in several data sets.
bool is_one_sweep(const PolarSweep& a, const PolarSweep& b) {
    const auto is_same = [](const Radial& one, const Radial& other) {
        return one.time == other.time && one.azimuth_deg == other.azimuth_deg &&
               one.elevation_deg == other.elevation_deg;
    };
    const bool shares_moments = std::ranges::any_of(b.sources, [&](const MomentSource& source) {
        return std::ranges::find(a.sources, source.moment, &MomentSource::moment) !=
               a.sources.end();
    });
    return !shares_moments && a.sweep.elevation_number == b.sweep.elevation_number &&
           std::ranges::equal(a.sweep.radials, b.sweep.radials, is_same);
}

void add_sweep(PolarFile& file, PolarSweep sweep) {
    if (file.sweeps.empty() || !is_one_sweep(file.sweeps.back(), sweep)) {
        file.sweeps.push_back(std::move(sweep));
        return;
    }
    for (MomentSource& source : sweep.sources)
        file.sweeps.back().sources.push_back(std::move(source));
}

std::string kind_of_object(std::string_view object) {
    if (object == "COMP") return "a composite of several radars";
    if (object == "IMAGE") return "an image";
    if (object == "CVOL") return "a volume on a grid";
    if (object == "RHI" || object == "ELEV") return "a vertical section";
    if (object == "XSEC") return "a section";
    if (object == "VP") return "a vertical profile";
    return "no volume";
}

}  // namespace

bool is_odim(const Group& root) {
    const auto conventions = root.attributes.text("Conventions");
    if (conventions && conventions->starts_with("ODIM")) return true;
    const Group* what = root.group("what");
    return what != nullptr && what->attributes.find("object") != nullptr;
}

Result<PolarFile> read_odim(const Group& root) {
    const Place place{{&root}};
    const std::string object = place.text("what", "object").value_or("");
    if (object != "PVOL" && object != "SCAN") {
        return fail(ErrorCode::unsupported,
                    "holds the ODIM_H5 object '{}', {}; only volumes and scans of one radar (PVOL, "
                    "SCAN) are read",
                    object, kind_of_object(object));
    }
    PolarFile file;
    file.format = root.attributes.text("Conventions").value_or("ODIM_H5");
    file.source = place.text("what", "source").value_or("");
    file.is_partial = place.text("how", "volume") == "partial";
    const auto latitude_deg = place.number("where", "lat"),
               longitude_deg = place.number("where", "lon");
    if (latitude_deg && longitude_deg) {
        file.block.latitude_deg = static_cast<float>(*latitude_deg);
        file.block.longitude_deg = static_cast<float>(*longitude_deg);
        const double height_m = place.number("where", "height").value_or(0);
        file.block.site_height_m =
            static_cast<std::int16_t>(std::lround(std::abs(height_m) < 30'000 ? height_m : 0));
    }
    file.station = station_of(file.source, file.block);
    for (const Group* dataset : numbered(root, "dataset")) {
        auto sweep = sweep_of(root, *dataset, file);
        if (sweep)
            add_sweep(file, std::move(*sweep));
        else
            file.left_out.push_back(dataset->name);
    }
    if (file.sweeps.empty())
        return fail(ErrorCode::corrupt, "is an ODIM_H5 file without a sweep that can be read{}",
                    file.left_out.empty() ? "" : "; its quantities are no moments");
    return file;
}

}  // namespace stormcellar::level2
