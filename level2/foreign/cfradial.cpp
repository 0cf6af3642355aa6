#include "level2/foreign/cfradial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "level2/foreign/cfradial_values.h"
#include "level2/foreign/quantity_names.h"

namespace stormcellar::level2 {
namespace {

using arrayfile::Array;
using arrayfile::Attributes;
using arrayfile::ElementKind;
using arrayfile::Group;

// Returns the nearest number of this type.
template <class Number>
Number number(double value) {
    constexpr double most = std::numeric_limits<Number>::max();
    return static_cast<Number>(std::clamp(value, 0.0, most));
}

// Distances to the centers of gates.
struct Axis {
    std::string name;
    std::size_t gates = 0;
    double first_m = 0, spacing_m = 0;
};

// A field, before it is cut into sweeps.
struct Field {
    Quantity quantity;
    std::string name;
    bool is_own = false;  // its codes are those of a Volume
    MomentSource source;
    std::size_t gates = 0;  // in a full radial
    // One number for each sweep, if this program moved gates to another axis.
    std::vector<double> repeats, starts, first_gates_m;
};

// Reads the sweeps of one group.
class GroupReader {
  public:
    GroupReader(const CfradialValues& values, const Group& group, PolarFile& file)
        : values_(values), group_(group), file_(file) {}

    // Sets the common facts of the file before the sweeps. `sweeps` are first and last rays.
    Status read();

  private:
    Status read_axes();
    Status read_rays();
    Status read_fields();
    std::optional<Field> field_of(const Array& array) const;
    [[nodiscard]] const Axis* axis_of(const Array& array) const;
    void set_marks(const Array& array, Field& field) const;
    void take_sweep(std::size_t index, std::size_t first_ray, std::size_t last_ray);
    void set_radials(Sweep& sweep, std::size_t first_ray) const;
    std::optional<MomentSource> cut(const Field& field, std::size_t sweep, std::size_t first_ray,
                                    std::size_t rays) const;
    [[nodiscard]] std::vector<double> numbers(std::string_view name) const {
        return values_.numbers(group_, name);
    }

    const CfradialValues& values_;
    const Group& group_;
    PolarFile& file_;
    std::vector<Axis> axes_;
    std::vector<UtcTime> times_;
    std::vector<double> azimuths_deg_, elevations_deg_, ray_gates_, ray_starts_, fixed_deg_, cuts_,
        spacings_deg_, messages_;
    std::vector<Field> fields_;
};

Status GroupReader::read_axes() {
    for (const Array& array : group_.arrays) {
        if (!array.name.starts_with("range") || array.shape.size() != 1) continue;
        const std::vector<double> centers_m = values_.numbers(array);
        if (centers_m.empty()) continue;
        Axis axis{array.name, centers_m.size(), centers_m[0], 0};
        const auto gates = static_cast<double>(centers_m.size());
        axis.spacing_m = centers_m.size() > 1 ? (centers_m.back() - centers_m[0]) / (gates - 1)
                                              : array.attributes.number("meters_between_gates")
                                                    .value_or(2 * std::abs(centers_m[0]));
        constexpr double same_share = 0.02;
        for (std::size_t i = 0; i < centers_m.size(); ++i) {
            const double expected_m = axis.first_m + axis.spacing_m * static_cast<double>(i);
            if (!(std::abs(centers_m[i] - expected_m) <= 1 + same_share * std::abs(axis.spacing_m)))
                return fail(ErrorCode::unsupported, "the gates of {} differ in length", array.name);
        }
        axes_.push_back(axis);
    }
    if (axes_.empty()) return fail(ErrorCode::corrupt, "the CfRadial file has no range of gates");
    std::ranges::sort(axes_, {}, &Axis::name);
    return {};
}

Status GroupReader::read_rays() {
    const auto times = values_.times(group_);
    if (!times) return pass_on(times);
    times_ = *times;
    azimuths_deg_ = numbers("azimuth");
    elevations_deg_ = numbers("elevation");
    if (times_.empty() || azimuths_deg_.size() != times_.size() ||
        elevations_deg_.size() != times_.size())
        return fail(ErrorCode::corrupt,
                    "the CfRadial file has {} times, {} azimuths and {} elevations of rays",
                    times_.size(), azimuths_deg_.size(), elevations_deg_.size());
    ray_gates_ = numbers("ray_n_gates");
    ray_starts_ = numbers("ray_start_index");
    if (ray_gates_.size() != times_.size() || ray_starts_.size() != times_.size()) {
        ray_gates_.clear();
        ray_starts_.clear();
    }
    return {};
}

// Returns the axis of a field with a row for each ray. Without names of dimensions, the number of
// gates tells it.
const Axis* GroupReader::axis_of(const Array& array) const {
    if (array.dimensions.size() == 2) {
        const auto named = std::ranges::find(axes_, array.dimensions[1], &Axis::name);
        if (named != axes_.end()) return &*named;
    }
    const auto same = std::ranges::find(axes_, array.shape[1], &Axis::gates);
    return same == axes_.end() ? nullptr : &*same;
}

void GroupReader::set_marks(const Array& array, Field& field) const {
    const Attributes& facts = array.attributes;
    MomentSource& source = field.source;
    source.gain = facts.number("scale_factor").value_or(1);
    source.offset = facts.number("add_offset").value_or(0);
    const auto undetect = facts.number("_Undetect");
    if (undetect) source.below.push_back(*undetect);
    for (const std::string_view name : {"_FillValue", "missing_value"}) {
        const auto mark = facts.number(name);
        if (mark) (undetect ? source.missing : source.below).push_back(*mark);
    }
    source.states = group_.array(array.name + "_status");
    if (source.states != nullptr && source.states->shape != array.shape) source.states = nullptr;
    const auto scale = facts.number("level2_scale"), offset = facts.number("level2_offset");
    const bool is_wide = facts.number("level2_word_size") == 16;
    constexpr double most = 1e9;
    field.is_own = scale && offset && source.states != nullptr && std::abs(*scale) < most &&
                   std::abs(*offset) < most;
    if (!field.is_own) {
        source.states = nullptr;
        // A sweep without echo holds no reflectivity, but it was measured.
        source.is_left_out_if_empty = source.moment != Moment::ref;
        return;
    }
    source.packing = MomentSource::KnownPacking{static_cast<float>(*scale),
                                                static_cast<float>(*offset), is_wide ? 16 : 8};
    field.repeats = numbers(array.name + "_gate_repeats");
    field.starts = numbers(array.name + "_gate_start");
    field.first_gates_m = numbers(array.name + "_first_gate");
}

std::optional<Field> GroupReader::field_of(const Array& array) const {
    const bool is_ragged = array.shape.size() == 1 && !ray_gates_.empty() &&
                           array.shape[0] != times_.size() && array.type.is_number();
    const bool is_full = array.shape.size() == 2 && array.shape[0] == times_.size();
    if ((!is_ragged && !is_full) || !array.type.is_number() || array.name.ends_with("_status"))
        return std::nullopt;
    Field field;
    field.name = array.name;
    const auto moment = moment_from_name(array.attributes.text("moment").value_or(""));
    auto quantity = moment ? std::optional{Quantity{*moment, 0}} : quantity_named(array.name);
    if (!quantity)
        quantity = quantity_of_standard_name(array.attributes.text("standard_name").value_or(""));
    const Axis* axis = is_full ? axis_of(array) : &axes_.front();
    if (!quantity || axis == nullptr || facts_of(quantity->moment).is_derived) return std::nullopt;
    field.quantity = *quantity;
    field.gates = is_full ? static_cast<std::size_t>(array.shape[1]) : axis->gates;
    field.source.moment = quantity->moment;
    field.source.array = &array;
    field.source.first_gate_m = axis->first_m;
    field.source.gate_spacing_m = axis->spacing_m;
    set_marks(array, field);
    return field;
}

Status GroupReader::read_fields() {
    for (const Array& array : group_.arrays) {
        auto field = field_of(array);
        if (!field) {
            const bool is_field = array.shape.size() == 2 && array.shape[0] == times_.size() &&
                                  array.type.is_number() && !array.name.ends_with("_status");
            if (is_field) file_.left_out.push_back(array.name);
            continue;
        }
        const auto same = std::ranges::find_if(fields_, [&](const Field& one) {
            return one.quantity.moment == field->quantity.moment && !(one.is_own && field->is_own);
        });
        if (same == fields_.end()) {
            fields_.push_back(std::move(*field));
        } else {
            if (field->quantity.rank < same->quantity.rank) std::swap(*field, *same);
            file_.left_out.push_back(field->name);
        }
    }
    return {};
}

void GroupReader::set_radials(Sweep& sweep, std::size_t first_ray) const {
    struct Fact {
        std::string_view name;
        void (*set)(Radial&, double);
    };
    static constexpr auto narrow = [](double value) { return static_cast<float>(value); };
    static constexpr Fact facts[] = {
        {"nyquist_velocity", [](Radial& r, double v) { r.nyquist_mps = narrow(v); }},
        {"unambiguous_range", [](Radial& r, double v) { r.unambiguous_range_m = narrow(v); }},
        {"calibration_dbz0_h", [](Radial& r, double v) { r.calibration_dbz = narrow(v); }},
        {"calibration_dbz0_v", [](Radial& r, double v) { r.vertical_calibration_dbz = narrow(v); }},
        {"radar_measured_sky_noise",
         [](Radial& r, double v) { r.horizontal_noise_dbm = narrow(v); }},
        {"radar_measured_sky_noise_v",
         [](Radial& r, double v) { r.vertical_noise_dbm = narrow(v); }},
        {"azimuth_number",
         [](Radial& r, double v) { r.azimuth_number = number<std::uint16_t>(v); }},
        {"radial_status", [](Radial& r, double v) { r.status = number<std::uint8_t>(v); }},
    };
    for (const Fact& fact : facts) {
        const Array* array = group_.array(fact.name);
        if (array == nullptr) continue;
        const std::vector<double> all = values_.numbers(*array);
        for (std::size_t i = 0; i < sweep.radials.size(); ++i) {
            // A single number applies to all rays.
            const std::size_t at = all.size() == 1 ? 0 : first_ray + i;
            const bool is_known = at < all.size() && std::isfinite(all[at]) && all[at] > -9000;
            if (is_known && all[at] < 1e6) fact.set(sweep.radials[i], all[at]);
        }
    }
}

// Cuts the rays of one sweep out of a field.
std::optional<MomentSource> GroupReader::cut(const Field& field, std::size_t sweep,
                                             std::size_t first_ray, std::size_t rays) const {
    MomentSource source = field.source;
    std::size_t start = 0;
    if (sweep < field.repeats.size() && sweep < field.starts.size() &&
        sweep < field.first_gates_m.size()) {
        const double repeats = field.repeats[sweep];
        if (!(repeats >= 1 && repeats <= 1000)) return std::nullopt;  // this sweep has no gates
        source.step = static_cast<std::size_t>(repeats);
        start = static_cast<std::size_t>(std::clamp(field.starts[sweep], 0.0, 1e6));
        source.first_gate_m = field.first_gates_m[sweep];
        source.gate_spacing_m *= repeats;
    }
    for (std::size_t ray = first_ray; ray < first_ray + rays; ++ray) {
        GateRow row{ray * field.gates + start,
                    static_cast<std::uint32_t>(
                        start < field.gates ? (field.gates - start) / source.step : 0)};
        if (field.source.array->shape.size() == 1) {
            row.first = static_cast<std::size_t>(std::clamp(ray_starts_[ray], 0.0, 1e12));
            row.gates = static_cast<std::uint32_t>(std::clamp(ray_gates_[ray], 0.0, 1e6));
        }
        source.rows.push_back(row);
    }
    return source;
}

void GroupReader::take_sweep(std::size_t index, std::size_t first_ray, std::size_t last_ray) {
    PolarSweep made;
    for (std::size_t ray = first_ray; ray <= last_ray; ++ray) {
        Radial& radial = made.sweep.radials.emplace_back();
        radial.time = times_[ray];
        const double turned_deg = std::fmod(azimuths_deg_[ray], 360);
        radial.azimuth_deg = static_cast<float>(turned_deg < 0 ? turned_deg + 360 : turned_deg);
        radial.elevation_deg = static_cast<float>(elevations_deg_[ray]);
    }
    set_radials(made.sweep, first_ray);
    if (index < cuts_.size() && cuts_[index] >= 1)
        made.sweep.elevation_number = number<std::uint8_t>(cuts_[index]);
    if (index < spacings_deg_.size() && (spacings_deg_[index] == 0.5 || spacings_deg_[index] == 1))
        made.sweep.azimuth_spacing_deg = static_cast<float>(spacings_deg_[index]);
    if (index < messages_.size() && messages_[index] == 1) made.sweep.message_type = 1;
    if (index < fixed_deg_.size() && std::abs(fixed_deg_[index]) <= 90)
        made.sweep.vcp_elevation_deg = static_cast<float>(fixed_deg_[index]);
    for (const Field& field : fields_) {
        if (auto source = cut(field, index, first_ray, last_ray - first_ray + 1))
            made.sources.push_back(std::move(*source));
    }
    if (!made.sources.empty()) file_.sweeps.push_back(std::move(made));
}

Status GroupReader::read() {
    if (Status rays = read_rays(); !rays) return rays;
    if (Status axes = read_axes(); !axes) return axes;
    if (Status fields = read_fields(); !fields) return fields;
    fixed_deg_ = numbers("fixed_angle");
    if (fixed_deg_.empty()) fixed_deg_ = numbers("sweep_fixed_angle");
    cuts_ = numbers("elevation_number");
    messages_ = numbers("message_type");
    spacings_deg_ = numbers("ray_angle_res");
    const std::vector<double> starts = numbers("sweep_start_ray_index");
    const std::vector<double> ends = numbers("sweep_end_ray_index");
    const std::vector<std::string> modes = values_.texts(group_, "sweep_mode");
    const auto rays = static_cast<double>(times_.size());
    const bool is_one = starts.empty() || starts.size() != ends.size();
    const std::size_t count = is_one ? 1 : starts.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double first = is_one ? 0 : starts[i], last = is_one ? rays - 1 : ends[i];
        if (!(first >= 0 && first <= last && last < rays))
            return fail(ErrorCode::corrupt, "sweep {} of the CfRadial file has rays {} to {} of {}",
                        i, first, last, rays);
        const std::string mode = i < modes.size() ? modes[i] : "";
        const bool is_flat = mode != "rhi" && mode != "vertical_pointing" && mode != "pointing" &&
                             mode != "elevation_surveillance" && mode != "manual_rhi";
        if (is_flat)
            take_sweep(i, static_cast<std::size_t>(first), static_cast<std::size_t>(last));
        else
            file_.left_out.push_back("sweep " + std::to_string(i) + " (" + mode + ")");
    }
    return {};
}

// Reads the radar's name and position.
Status read_site(const CfradialValues& values, const Group& root, PolarFile& file) {
    const auto latitude = values.numbers(root, "latitude");
    const auto longitude = values.numbers(root, "longitude");
    const auto altitude = values.numbers(root, "altitude");
    if (latitude.size() > 1)
        return fail(ErrorCode::unsupported, "is a CfRadial file of a moving radar");
    const auto within = [](const std::vector<double>& numbers, double most) {
        return !numbers.empty() && std::abs(numbers[0]) <= most;
    };
    if (within(latitude, 90) && within(longitude, 360)) {
        file.block.latitude_deg = static_cast<float>(latitude[0]);
        file.block.longitude_deg = static_cast<float>(std::remainder(longitude[0], 360));
        if (within(altitude, 30'000))
            file.block.site_height_m = static_cast<std::int16_t>(std::lround(altitude[0]));
    }
    for (const std::string_view name : {"instrument_name", "site_name"}) {
        std::string found = root.attributes.text(name).value_or("");
        if (const auto texts = values.texts(root, name); found.empty() && !texts.empty())
            found = texts[0];
        if (file.source.empty() && found != "unknown") file.source = found;
    }
    file.station = station_of(file.source, file.block);
    return {};
}

}  // namespace

bool is_cfradial(const Group& root) {
    const std::string conventions = root.attributes.text("Conventions").value_or("");
    for (const std::string_view name :
         {"CF/Radial", "Cf/Radial", "CF-Radial", "CfRadial", "FM301"}) {
        if (conventions.find(name) != std::string::npos) return true;
    }
    const auto has_rays = [](const Group& group) {
        return group.array("azimuth") != nullptr && group.array("elevation") != nullptr &&
               group.array("time") != nullptr && group.array("range") != nullptr;
    };
    return has_rays(root) || std::ranges::any_of(root.groups, [&](const Group& group) {
               return group.name.starts_with("sweep") && has_rays(group);
           });
}

Result<PolarFile> read_cfradial(std::span<const std::byte> bytes, const Group& root,
                                std::uint64_t most_bytes) {
    const CfradialValues values{bytes, most_bytes};
    PolarFile file;
    if (Status site = read_site(values, root, file); !site) return pass_on(site);
    const bool is_one_group = root.array("azimuth") != nullptr;
    const std::string version = root.attributes.text("version").value_or("");
    file.format =
        is_one_group ? "CfRadial " + (version.starts_with("1.") ? version : "1") : "CfRadial 2";
    file.is_partial = root.attributes.text("volume") == "partial";
    if (root.array("message_type") != nullptr) {
        if (const auto vcp = root.attributes.number("scan_id")) file.vcp = static_cast<int>(*vcp);
    }
    std::vector<const Group*> groups;
    if (is_one_group) groups.push_back(&root);
    for (const Group& group : root.groups) {
        if (!is_one_group && group.name.starts_with("sweep")) groups.push_back(&group);
    }
    // The numbers of sweeps may have different lengths.
    std::ranges::stable_sort(groups, {}, [](const Group* group) { return group->name.size(); });
    for (const Group* group : groups) {
        if (Status read = GroupReader{values, *group, file}.read(); !read) return pass_on(read);
    }
    if (file.sweeps.empty())
        return fail(ErrorCode::unsupported,
                    "is a CfRadial file without a sweep at a fixed elevation that holds a moment");
    return file;
}

}  // namespace stormcellar::level2
