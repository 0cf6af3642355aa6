// Writes the moments of a CfRadial file: packed codes, and the status of each gate.
#include <algorithm>
#include <array>

#include <netcdf.h>

#include "export/cfradial_parts.h"

namespace stormcellar::netcdf {
namespace {

using level2::GateStatus;
using level2::Moment;
using level2::SweepMoment;

// Marks elements that have no code. All codes are 0 or more, so this fill value is negative.
constexpr int fill_code = -1;
// The status variable of CFP stores its flags, which are codes 0 to 7, as this number plus the
// code.
constexpr int first_filter_flag = 16;
// A chunk holds at most half a sweep of half-degree radials. A sweep may end within a chunk, so the
// last two chunks are kept unpacked; in them, an int takes four bytes.
constexpr std::size_t chunk_rows = 360;
constexpr std::size_t chunk_codes = std::size_t{1} << 18;
constexpr std::size_t chunk_cache_bytes = 2 * 4 * chunk_codes;

struct NamedStatus {
    int value;
    std::string meaning;
};

bool has_flags(Moment moment) {
    const level2::MomentFacts& facts = level2::facts_of(moment);
    return facts.first_valid_code > 2 && !facts.is_derived;
}

std::vector<NamedStatus> states_of(Moment moment) {
    constexpr auto number = [](GateStatus status) { return static_cast<int>(status); };
    if (!has_flags(moment)) {
        std::vector<NamedStatus> states = {{number(GateStatus::valid), "valid"},
                                           {number(GateStatus::below_threshold), "below_threshold"},
                                           {number(GateStatus::range_folded), "range_folded"},
                                           {number(GateStatus::no_data), "no_data"}};
        if (level2::facts_of(moment).is_derived)
            states.push_back({number(GateStatus::ambiguous), "ambiguous"});
        return states;
    }
    std::vector<NamedStatus> states = {{number(GateStatus::valid), "valid"},
                                       {number(GateStatus::no_data), "no_data"}};
    for (int flag = 0; flag < level2::facts_of(moment).first_valid_code; ++flag)
        states.push_back({first_filter_flag + flag, fmt::format("filter_flag_{}", flag)});
    return states;
}

int status_of(const SweepMoment& moment, std::size_t radial, std::int32_t gate) {
    const GateStatus status = moment.status(radial, gate);
    const bool flag = has_flags(moment.moment) && status == GateStatus::no_data &&
                      gate < moment.gate_counts[radial];
    return flag ? first_filter_flag + moment.code(radial, gate) : static_cast<int>(status);
}

std::vector<std::size_t> chunks_of(const CfradialParts& parts, std::size_t gates) {
    const std::size_t rows = std::clamp<std::size_t>(chunk_codes / gates, 1, chunk_rows);
    return {std::min(rows, parts.layout.radials), gates};
}

int define_on_gates(const CfradialParts& parts, const CfradialField& field, const std::string& name,
                    int type) {
    const RangeAxis& axis = parts.layout.axes[field.axis];
    const int variable =
        parts.file.variable(name.c_str(), type, {parts.time, parts.ranges[field.axis]});
    parts.file.chunks(variable, chunks_of(parts, axis.gates));
    parts.file.chunk_cache(variable, chunk_cache_bytes);
    parts.file.deflate(variable, parts.deflate_level);
    parts.file.text(variable, "coordinates", "elevation azimuth " + axis.name);
    parts.file.text(variable, "moment", level2::moment_name(field.kind->moment));
    return variable;
}

int define_codes(const CfradialParts& parts, const CfradialField& field) {
    NetcdfBuilder& file = parts.file;
    const SweepMoment& kind = *field.kind;
    const int codes =
        define_on_gates(parts, field, field.name, kind.word_size_bits == 8 ? NC_SHORT : NC_INT);
    file.fill_value(codes, fill_code);
    const level2::MomentFacts& facts = level2::facts_of(kind.moment);
    file.text(codes, "long_name", facts.netcdf.long_name);
    if (!field.standard_name.empty()) file.text(codes, "standard_name", field.standard_name);
    file.text(codes, "units", facts.units);
    // If the scale is 0, the code itself is the value.
    const double scale = kind.scale == 0 ? 1.0 : static_cast<double>(kind.scale);
    const double offset = kind.scale == 0 ? 0.0 : static_cast<double>(kind.offset);
    file.number(codes, "scale_factor", 1 / scale);
    file.number(codes, "add_offset", offset == 0 ? 0.0 : -offset / scale);
    file.text(codes, "ancillary_variables", field.name + "_status");
    file.number(codes, "level2_scale", static_cast<double>(kind.scale));
    file.number(codes, "level2_offset", static_cast<double>(kind.offset));
    file.number(codes, "level2_word_size", kind.word_size_bits);
    if (facts.circle == level2::Circle::full_turn) {
        file.text(codes, "field_folds", "true");
        file.number(codes, "fold_limit_lower", 0.0);
        file.number(codes, "fold_limit_upper", 360.0);
    }
    return codes;
}

int define_status(const CfradialParts& parts, const CfradialField& field) {
    NetcdfBuilder& file = parts.file;
    const int status = define_on_gates(parts, field, field.name + "_status", NC_BYTE);
    file.text(status, "long_name", "what a gate of " + field.name + " holds");
    file.text(status, "standard_name", "status_flag");
    std::vector<signed char> values;
    std::string meanings;
    for (const NamedStatus& state : states_of(field.kind->moment)) {
        values.push_back(static_cast<signed char>(state.value));
        meanings += (meanings.empty() ? "" : " ") + state.meaning;
    }
    file.bytes(status, "flag_values", values);
    file.text(status, "flag_meanings", meanings);
    file.text(status, "is_discrete", "true");
    file.text(status, "is_quality_field", "true");
    file.text(status, "qualified_variables", field.name);
    file.text(status, "comment",
              has_flags(field.kind->moment)
                  ? "no_data: the radial has no such gate; filter_flag_N: code N, which is a flag "
                    "of the clutter filter and no power (ICD 2620002)"
                  : "below_threshold: seen, code 0; range_folded: echo from beyond the unambiguous "
                    "range, code 1; no_data: the radial has no such gate");
    return status;
}

struct SweepGates {
    std::vector<int> codes;
    std::vector<signed char> states;
};

// Unpacks the rows of one sweep into `to`, whose vectors are reused. If the moment is null, the
// rows have no gates.
void unpack(const SweepMoment* moment, const RangeAxis& axis, std::size_t radials, SweepGates& to) {
    to.codes.assign(radials * axis.gates, fill_code);
    to.states.assign(radials * axis.gates, static_cast<signed char>(GateStatus::no_data));
    if (moment == nullptr) return;
    const GatePlacement placed = place_gates(axis, *moment);
    for (std::size_t radial = 0; radial < radials; ++radial) {
        std::size_t at = radial * axis.gates + placed.first;
        const auto count = static_cast<std::int32_t>(moment->gate_counts[radial]);
        for (std::int32_t gate = 0; gate < count; ++gate, at += placed.repeats) {
            const int status = status_of(*moment, radial, gate);
            const bool valid = status == static_cast<int>(GateStatus::valid);
            const auto begin = static_cast<std::ptrdiff_t>(at);
            const auto repeats = static_cast<std::ptrdiff_t>(placed.repeats);
            std::fill_n(to.states.begin() + begin, repeats, static_cast<signed char>(status));
            if (valid) std::fill_n(to.codes.begin() + begin, repeats, moment->code(radial, gate));
        }
    }
}

// Writes how to get the measured gates of each sweep back. Writes nothing if the axis neither
// repeats nor shifts gates.
void write_placement(const CfradialParts& parts, const CfradialField& field) {
    std::vector<int> repeats;
    std::vector<int> first;
    std::vector<int> first_gate_m;
    bool moved = false;
    for (const SweepMoment* moment : field.sweeps) {
        const GatePlacement placed = moment == nullptr
                                         ? GatePlacement{0, 0}
                                         : place_gates(parts.layout.axes[field.axis], *moment);
        moved = moved || placed.repeats > 1 || placed.first > 0;
        repeats.push_back(static_cast<int>(placed.repeats));
        first.push_back(static_cast<int>(placed.first));
        first_gate_m.push_back(moment == nullptr ? 0 : moment->first_gate_m);
    }
    if (!moved) return;
    const auto write = [&](const char* ending, const char* long_name, const char* units,
                           const std::vector<int>& values) {
        const int made =
            parts.variable((field.name + ending).c_str(), NC_INT, parts.sweep, long_name, units);
        parts.file.write(made, std::span<const int>(values));
    };
    write("_gate_repeats", "elements of range that one measured gate fills; 0: no gates", "1",
          repeats);
    write("_gate_start", "element of range where the first measured gate begins, from 0", "1",
          first);
    write("_first_gate", "distance to the center of the first measured gate", "meters",
          first_gate_m);
}

void write_field(const CfradialParts& parts, const CfradialField& field, SweepGates& gates) {
    const int codes = define_codes(parts, field);
    const int status = define_status(parts, field);
    write_placement(parts, field);
    const RangeAxis& axis = parts.layout.axes[field.axis];
    for (std::size_t sweep = 0; sweep < field.sweeps.size(); ++sweep) {
        const NetcdfBuilder::Rows rows{parts.layout.first_radials[sweep],
                                       parts.sweeps[sweep].radials.size(), axis.gates};
        unpack(field.sweeps[sweep], axis, rows.count, gates);
        parts.file.write_rows(codes, rows, std::span<const int>(gates.codes));
        parts.file.write_rows(status, rows, std::span<const signed char>(gates.states));
    }
}

}  // namespace

void write_fields(const CfradialParts& parts) {
    SweepGates gates;
    for (const CfradialField& field : parts.layout.fields)
        write_field(parts, field, gates);
}

}  // namespace stormcellar::netcdf
