#include "export/uf.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/printable.h"
#include "export/cfradial_layout.h"
#include "export/exchange_names.h"
#include "export/uf_record.h"
#include "export/uf_scale.h"
#include "export/volume_facts.h"

namespace stormcellar::netcdf {
namespace {

using level2::Moment;
using level2::Radial;
using level2::Sweep;
using level2::SweepMoment;
using level2::Volume;

constexpr std::size_t most_words = 32'767;  // of a record; also the most radials of a file
constexpr std::size_t header_words = 45;

struct UfField {
    Moment moment = Moment::ref;
    int factor = 1;
};

// The facts that all records of a file share.
struct UfFile {
    const Volume& volume;
    std::vector<UfField> fields;
    std::optional<RangeAxis> axis;  // none: each field has its own gates
    std::optional<level2::AntennaPosition> antenna;
    UtcTime start;
};

// The facts that all records of a sweep share.
struct UfSweep {
    const Sweep& sweep;
    std::size_t number;                            // from 1
    std::vector<std::vector<std::int16_t>> words;  // of each code, in the order of sweep.moments
    double fixed_deg = 0;
    std::optional<double> degrees_per_second;
};

// One field of one radial.
struct FieldGates {
    const UfField& field;
    const SweepMoment* moment;               // null: the radial lacks the field
    const std::vector<std::int16_t>* words;  // of each code
};

Result<std::vector<UfField>> fields_of(const Volume& volume) {
    std::vector<UfField> fields;
    for (const Moment name : level2::all_moments) {
        const bool is_there =
            std::any_of(volume.sweeps.begin(), volume.sweeps.end(),
                        [&](const Sweep& sweep) { return sweep.find(name) != nullptr; });
        if (!is_there) continue;
        const auto factor = uf_factor(volume.sweeps, name);
        if (!factor) return pass_on(factor);
        fields.push_back({name, *factor});
    }
    return fields;
}

// Returns the mean speed of the antenna; none if the times of the radials do not tell it.
std::optional<double> degrees_per_second(const Sweep& sweep) {
    const double seconds = seconds_between(sweep.radials.front().time, sweep.radials.back().time);
    double turned_deg = 0;
    for (std::size_t i = 1; i < sweep.radials.size(); ++i) {
        const float step_deg = sweep.radials[i].azimuth_deg - sweep.radials[i - 1].azimuth_deg;
        turned_deg += std::remainder(static_cast<double>(step_deg), 360.0);
    }
    if (!(seconds > 0) || turned_deg == 0) return std::nullopt;
    return std::abs(turned_deg) / seconds;
}

UfSweep prepare(const UfFile& file, std::size_t number) {
    const Sweep& sweep = file.volume.sweeps[number];
    UfSweep made{sweep,
                 number + 1,
                 {},
                 static_cast<double>(fixed_angle_deg(sweep)),
                 degrees_per_second(sweep)};
    for (const SweepMoment& moment : sweep.moments) {
        const auto field =
            std::find_if(file.fields.begin(), file.fields.end(),
                         [&](const UfField& one) { return one.moment == moment.moment; });
        made.words.push_back(uf_words(moment, field->factor));
    }
    return made;
}

FieldGates gates_of(const UfSweep& from, const UfField& field, std::size_t radial) {
    for (std::size_t i = 0; i < from.sweep.moments.size(); ++i) {
        const SweepMoment& moment = from.sweep.moments[i];
        if (moment.moment == field.moment && moment.gate_counts[radial] > 0)
            return {field, &moment, &from.words[i]};
    }
    return {field, nullptr, nullptr};
}

// Returns how many elements of the axis the radial's gates reach.
std::size_t reach_of(const Sweep& sweep, const RangeAxis& axis, std::size_t radial) {
    std::size_t reach = 0;
    for (const SweepMoment& moment : sweep.moments) {
        const std::size_t gates = moment.gate_counts[radial];
        if (gates == 0) continue;
        const GatePlacement placed = place_gates(axis, moment);
        reach = std::max(reach, placed.first + gates * placed.repeats);
    }
    return reach;
}

// Returns how many gates the fields of a radial have on the axis.
std::size_t gates_on_axis(const UfSweep& from, const RangeAxis& axis, std::size_t radial) {
    if (radial > 0) return reach_of(from.sweep, axis, radial);
    if (from.number == 1) return axis.gates;
    std::size_t longest = 0;
    for (std::size_t other = 0; other < from.sweep.radials.size(); ++other)
        longest = std::max(longest, reach_of(from.sweep, axis, other));
    return longest;
}

void add_header(UfRecord& record, const UfFile& file, const UfSweep& from, const Radial& radial,
                std::size_t number) {
    const Volume& volume = file.volume;
    const std::string station = printable(volume.station);
    using Degrees = std::optional<double>;
    record.add_text("UF", 2);
    record.add(0.0);  // set when the record is whole
    for (int i = 0; i < 3; ++i)
        record.add(static_cast<double>(header_words + 1));
    record.add(static_cast<double>(number));
    record.add(volume.header ? volume.header->volume_number().value_or(1) : 1.0);
    record.add(static_cast<double>(number));
    record.add(1.0);
    record.add(static_cast<double>(from.number));
    record.add_text(station, 8);
    record.add_text(station, 8);
    record.add_angle(file.antenna ? Degrees{file.antenna->latitude_deg} : std::nullopt);
    record.add_angle(file.antenna ? Degrees{file.antenna->longitude_deg} : std::nullopt);
    record.add(file.antenna ? Degrees{file.antenna->altitude_m} : std::nullopt);
    record.add_time(radial.time);
    record.add_text("UT", 2);
    record.add(static_cast<double>(radial.azimuth_deg) * 64);
    record.add(static_cast<double>(radial.elevation_deg) * 64);
    record.add(1.0);  // PPI
    record.add(from.fixed_deg * 64);
    record.add(from.degrees_per_second ? Degrees{*from.degrees_per_second * 64} : std::nullopt);
    record.add_date(file.start);
    record.add_text("stormcel", 8);
    record.add_missing(1);
}

// Adds a field header and the gates of its axis.
void add_field(UfRecord& record, const FieldGates& gates, const RangeAxis& axis,
               const Radial& radial) {
    const auto factor = static_cast<double>(gates.field.factor);
    const bool has_nyquist = exchange_names_of(gates.field.moment).uf.front() == 'V';
    // Some readers ignore the kilometers, so all of the range is in meters if a word can hold it.
    constexpr int most_m = static_cast<int>(most_words);
    const int kilometers = std::abs(axis.first_gate_m) > most_m ? axis.first_gate_m / 1000 : 0;
    record.add(static_cast<double>(record.next() + (has_nyquist ? 21 : 25)));
    record.add(factor);
    record.add(static_cast<double>(kilometers));
    record.add(static_cast<double>(axis.first_gate_m - 1000 * kilometers));
    record.add(static_cast<double>(axis.gate_spacing_m));
    record.add(static_cast<double>(axis.gates));
    record.add_missing(4);
    record.add(0.0);  // horizontal polarization
    record.add_missing(2);
    record.add_text("", 2);
    record.add_missing(1);
    record.add(factor);
    record.add_text("", 2);
    record.add_missing(1);
    record.add(16.0);
    if (has_nyquist) {
        record.add(radial.nyquist_mps > 0 ? std::optional(radial.nyquist_mps * factor)
                                          : std::nullopt);
        record.add_missing(1);
    } else {
        record.add_missing(6);
    }
}

void fill_gates(std::span<std::int16_t> to, const FieldGates& gates, const RangeAxis& axis,
                std::size_t radial) {
    if (gates.moment == nullptr) return;
    const GatePlacement placed = place_gates(axis, *gates.moment);
    std::size_t at = placed.first;
    for (std::int32_t gate = 0; gate < gates.moment->gate_counts[radial]; ++gate) {
        const std::int16_t word = (*gates.words)[gates.moment->code(radial, gate)];
        for (std::size_t i = 0; i < placed.repeats; ++i)
            to[at++] = word;
    }
}

void add_fields(UfRecord& record, const UfFile& file, const UfSweep& from, std::size_t radial) {
    std::vector<FieldGates> fields;
    for (const UfField& field : file.fields) {
        const FieldGates gates = gates_of(from, field, radial);
        if (file.axis || gates.moment != nullptr) fields.push_back(gates);
    }
    record.add(static_cast<double>(fields.size()));
    record.add(1.0);
    record.add(static_cast<double>(fields.size()));
    const std::size_t places = record.next();
    for (const FieldGates& gates : fields) {
        record.add_text(std::string(exchange_names_of(gates.field.moment).uf), 2);
        record.add_missing(1);  // set below
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const SweepMoment* moment = fields[i].moment;
        RangeAxis axis;
        if (file.axis) {
            axis = *file.axis;
            axis.gates = gates_on_axis(from, axis, radial);
        } else {
            axis = {{}, moment->first_gate_m, moment->gate_spacing_m, moment->gate_counts[radial]};
        }
        record.set(places + 2 * i + 1, record.next());
        add_field(record, fields[i], axis, from.sweep.radials[radial]);
        fill_gates(record.add_gates(axis.gates), fields[i], axis, radial);
    }
}

Result<std::vector<std::byte>> build(const UfFile& file) {
    std::vector<std::byte> bytes;
    UfRecord record;
    std::size_t number = 0;
    for (std::size_t sweep = 0; sweep < file.volume.sweeps.size(); ++sweep) {
        const UfSweep from = prepare(file, sweep);
        for (std::size_t radial = 0; radial < from.sweep.radials.size(); ++radial) {
            record.clear();
            add_header(record, file, from, from.sweep.radials[radial], ++number);
            add_fields(record, file, from, radial);
            const std::size_t words = record.next() - 1;
            if (words > most_words) {
                return fail(ErrorCode::unsupported,
                            "sweep {} has radials of {} words; UF holds at most {}", sweep, words,
                            most_words);
            }
            record.set(2, words);
            record.append_to(bytes);
        }
    }
    return bytes;
}

Status check(const Volume& volume) {
    if (Status good = check_sweeps(volume.sweeps); !good) return good;
    const std::size_t radials = volume.radial_count();
    if (radials == 0) {
        return fail(ErrorCode::unsupported,
                    "the volume has no radials, and UF is a list of radials");
    }
    if (radials > most_words) {
        return fail(ErrorCode::unsupported, "{} radials; UF counts at most {}", radials,
                    most_words);
    }
    return {};
}

}  // namespace

Status write_uf(FileSystem& file_system, const std::filesystem::path& path, const Volume& volume,
                const VolumeWriteOptions& options) {
    if (Status good = check(volume); !good)
        return fail(good.error().code, "{}: {}", path.string(), good.error().message);
    auto fields = fields_of(volume);
    if (!fields) return fail(fields.error().code, "{}: {}", path.string(), fields.error().message);
    const UfFile file{
        volume, std::move(*fields),
        options.ranges == RangeAxes::one_if_possible ? common_axis(volume.sweeps) : std::nullopt,
        level2::antenna_position(volume), coverage_of(volume).start};
    const auto bytes = build(file);
    if (!bytes) return fail(bytes.error().code, "{}: {}", path.string(), bytes.error().message);
    return write_file_atomically(file_system, path, *bytes);
}

}  // namespace stormcellar::netcdf
