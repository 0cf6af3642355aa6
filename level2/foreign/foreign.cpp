#include "level2/foreign/foreign.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/ranges.h>

#include "arrayfile/array_file.h"
#include "base/floating_point.h"
#include "base/printable.h"
#include "level2/foreign/cfradial.h"
#include "level2/foreign/gate_codes.h"
#include "level2/foreign/odim.h"

namespace stormcellar::level2 {
namespace {

using arrayfile::Array;
using arrayfile::Elements;

constexpr std::size_t most_names = 20;

Result<PolarFile> read_polar(std::span<const std::byte> bytes, const arrayfile::Group& root,
                             std::uint64_t most_bytes) {
    if (is_odim(root)) return read_odim(root);
    if (is_cfradial(root)) return read_cfradial(bytes, root, most_bytes);
    return fail(ErrorCode::not_level2,
                "is an HDF5 or netCDF file, but neither ODIM_H5 nor CfRadial");
}

// Leaves out the radials without a direction, and returns their number.
std::uint64_t drop_lost_radials(PolarFile& file) {
    std::uint64_t dropped = 0;
    for (PolarSweep& one : file.sweeps) {
        std::vector<Radial>& radials = one.sweep.radials;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < radials.size(); ++i) {
            const bool is_sound = is_within(radials[i].azimuth_deg, 0.0F, 360.0F) &&
                                  is_within(radials[i].elevation_deg, -90.0F, 90.0F);
            if (!is_sound) continue;
            for (MomentSource& source : one.sources)
                source.rows[kept] = source.rows[i];
            radials[kept++] = radials[i];
        }
        dropped += radials.size() - kept;
        radials.resize(kept);
        for (MomentSource& source : one.sources)
            source.rows.resize(kept);
    }
    std::erase_if(file.sweeps, [](const PolarSweep& one) { return one.sweep.radials.empty(); });
    return dropped;
}

// Sorts the sweeps by time, and gives numbers and states to sweeps and radials that have none.
void set_order(PolarFile& file) {
    std::ranges::stable_sort(file.sweeps, {},
                             [](const PolarSweep& one) { return one.sweep.radials.front().time; });
    for (std::size_t i = 0; i < file.sweeps.size(); ++i) {
        Sweep& sweep = file.sweeps[i].sweep;
        const std::size_t count = sweep.radials.size();
        const bool has_numbers = std::ranges::any_of(
            sweep.radials, [](const Radial& radial) { return radial.azimuth_number != 0; });
        if (sweep.elevation_number == 0) sweep.elevation_number = static_cast<int>(i + 1);
        for (const double spacing_deg : {0.5, 1.0}) {
            if (sweep.azimuth_spacing_deg == 0 &&
                std::abs(static_cast<double>(count) * spacing_deg - 360) <= spacing_deg)
                sweep.azimuth_spacing_deg = static_cast<float>(spacing_deg);
        }
        if (has_numbers) continue;
        for (std::size_t k = 0; k < count; ++k)
            sweep.radials[k].azimuth_number = static_cast<std::uint16_t>(k + 1);
        const bool is_last = i + 1 == file.sweeps.size();
        sweep.radials.front().status = static_cast<std::uint8_t>(
            i == 0 ? RadialStatus::start_of_volume : RadialStatus::start_of_elevation);
        sweep.radials.back().status = static_cast<std::uint8_t>(
            is_last ? RadialStatus::end_of_volume : RadialStatus::end_of_elevation);
    }
}

void add(DecodeReport& report, Severity severity, std::string code, std::string message) {
    if (severity == Severity::error) ++report.errors;
    Problem problem;
    problem.severity = severity;
    problem.code = std::move(code);
    problem.message = std::move(message);
    report.problems.push_back(std::move(problem));
}

// Reads the gates of all sweeps, array by array, because sweeps may share an array.
class GateReader {
  public:
    GateReader(std::span<const std::byte> bytes, PolarFile& file, const Selection& selection,
               std::uint64_t most_bytes)
        : bytes_(bytes), file_(file), selection_(selection), most_bytes_(most_bytes) {}

    Status read(DecodeReport& report) {
        std::map<const Array*, std::vector<Use>> uses;
        std::vector<const Array*> order;
        for (std::size_t sweep = 0; sweep < file_.sweeps.size(); ++sweep) {
            auto& sources = file_.sweeps[sweep].sources;
            for (const MomentSource& source : sources) {
                if (!selection_.wants(source.moment) ||
                    !selection_.wants_cut(file_.sweeps[sweep].sweep.elevation_number))
                    continue;
                auto& of_array = uses[source.array];
                if (of_array.empty()) order.push_back(source.array);
                of_array.push_back({sweep, &source});
            }
        }
        for (const Array* array : order) {
            if (Status taken = take(uses[array]); !taken) problems_.push_back(taken.error());
        }
        if (!order.empty() && problems_.size() == order.size())
            return tl::unexpected<Error>(problems_.front());
        note(report);
        return {};
    }

  private:
    struct Use {
        std::size_t sweep = 0;
        const MomentSource* source = nullptr;
    };

    Status take(const std::vector<Use>& uses) {
        const MomentSource& first = *uses.front().source;
        const auto elements = arrayfile::read_array(bytes_, *first.array, most_bytes_ - taken_);
        if (!elements) return pass_on(elements);
        Elements states;
        if (first.states != nullptr) {
            auto read = arrayfile::read_array(bytes_, *first.states, most_bytes_ - taken_);
            if (!read) return pass_on(read);
            states = std::move(*read);
        }
        const Packing packing = choose_packing(first, *elements);
        for (const Use& use : uses) {
            auto packed = pack_gates(*use.source, packing, *elements,
                                     first.states == nullptr ? nullptr : &states);
            if (!packed) return pass_on(packed);
            gaps_ += packed->gaps;
            beyond_ += packed->beyond;
            if (!packed->moment) continue;
            taken_ += packed->moment->codes8.size() + 2 * packed->moment->codes16.size();
            if (taken_ > most_bytes_)
                return fail(ErrorCode::unsupported, "the gates take more than {} bytes",
                            most_bytes_);
            file_.sweeps[use.sweep].sweep.moments.push_back(std::move(*packed->moment));
        }
        return {};
    }

    void note(DecodeReport& report) {
        if (!file_.source.empty() && file_.source != file_.station)
            add(report, Severity::note, "source",
                fmt::format("the radar is {}; its station here is {}", printable(file_.source),
                            file_.station));
        std::set<std::string> names(file_.left_out.begin(), file_.left_out.end());
        if (!names.empty()) {
            std::vector<std::string> some;
            for (const std::string& name : names)
                if (some.size() < most_names) some.push_back(printable(name));
            add(report, Severity::note, "left_out",
                fmt::format("left out, because no moment has room: {}{}", fmt::join(some, ", "),
                            names.size() > some.size() ? ", ..." : ""));
        }
        if (gaps_ > 0)
            add(report, Severity::note, "gaps",
                fmt::format("{} gates without data, between gates with data, count as range folded",
                            gaps_));
        if (beyond_ > 0)
            add(report, Severity::warning, "beyond",
                fmt::format("{} values are too large or small, and count as not measured",
                            beyond_));
        for (const Error& problem : problems_) {
            if (report.problems.size() == DecodeReport::max_problems) break;
            add(report, Severity::error, "array", printable(problem.message));
        }
    }

    std::span<const std::byte> bytes_;
    PolarFile& file_;
    const Selection& selection_;
    std::uint64_t most_bytes_;
    std::uint64_t taken_ = 0, gaps_ = 0, beyond_ = 0;
    std::vector<Error> problems_;
};

}  // namespace

bool is_foreign(std::span<const std::byte> bytes) {
    return arrayfile::is_hdf5(bytes) || arrayfile::is_classic_netcdf(bytes);
}

Result<Decoded> decode_foreign(std::span<const std::byte> bytes, const Selection& selection,
                               std::uint64_t most_array_bytes,
                               const std::string& fallback_station) {
    const MaskedTraps masked;  // numbers of a damaged file may be anything
    const auto root = arrayfile::read_tree(bytes);
    if (!root) return pass_on(root);
    auto file = read_polar(bytes, *root, most_array_bytes);
    if (!file) return pass_on(file);
    const std::uint64_t lost = drop_lost_radials(*file);
    if (file->sweeps.empty()) return fail(ErrorCode::corrupt, "no radial has a direction");
    set_order(*file);
    Decoded decoded;
    decoded.report.container = printable(file->format);
    Status read = GateReader{bytes, *file, selection, most_array_bytes}.read(decoded.report);
    if (!read) return pass_on(read);
    if (lost > 0)
        add(decoded.report, Severity::error, "lost_radials",
            fmt::format("{} radials without a direction are left out", lost));
    Volume& volume = decoded.volume;
    volume.station = file->station.empty() ? fallback_station : file->station;
    volume.block = file->block;
    volume.vcp = file->vcp;
    for (PolarSweep& one : file->sweeps) {
        if (!selection.wants_cut(one.sweep.elevation_number)) {
            ++decoded.report.sweeps_left_out;
            continue;
        }
        std::ranges::stable_sort(one.sweep.moments, {}, &SweepMoment::moment);
        volume.sweeps.push_back(std::move(one.sweep));
    }
    decoded.report.damaged = decoded.report.errors > 0;
    decoded.report.complete = !decoded.report.damaged && !file->is_partial;
    return decoded;
}

}  // namespace stormcellar::level2
