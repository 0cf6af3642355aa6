#include <algorithm>
#include <limits>
#include <type_traits>
#include <vector>

#include "capi/guarded.h"
#include "capi/volume_handle.h"

namespace stormcellar::capi {
namespace {

static_assert(static_cast<int>(level2::GateStatus::valid) == STORMCELLAR_GATE_VALUE);
static_assert(static_cast<int>(level2::GateStatus::below_threshold) ==
              STORMCELLAR_GATE_BELOW_THRESHOLD);
static_assert(static_cast<int>(level2::GateStatus::range_folded) == STORMCELLAR_GATE_RANGE_FOLDED);
static_assert(static_cast<int>(level2::GateStatus::no_data) == STORMCELLAR_GATE_NO_DATA);
static_assert(static_cast<int>(level2::GateStatus::ambiguous) == STORMCELLAR_GATE_AMBIGUOUS);

Status describe_sweep(const level2::Sweep& sweep, stormcellar_sweep_facts* to) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    stormcellar_sweep_facts facts{};
    facts.elevation_deg = sweep.mean_elevation_deg();
    facts.fixed_angle_deg =
        sweep.vcp_elevation_deg ? static_cast<double>(*sweep.vcp_elevation_deg) : unknown;
    facts.azimuth_spacing_deg = sweep.azimuth_spacing_deg > 0 ? sweep.azimuth_spacing_deg : unknown;
    const bool has_radials = !sweep.radials.empty();
    facts.start_ms = has_radials ? milliseconds_of(sweep.radials.front().time) : unknown_time;
    facts.end_ms = has_radials ? milliseconds_of(sweep.radials.back().time) : unknown_time;
    facts.elevation_number = sweep.elevation_number;
    facts.radials = static_cast<std::int32_t>(sweep.radials.size());
    facts.moments = static_cast<std::int32_t>(sweep.moments.size());
    return give(facts, to);
}

Status describe_moment(const level2::SweepMoment& moment, stormcellar_moment_facts* to) {
    stormcellar_moment_facts facts{};
    copy_text(level2::moment_name(moment.moment), facts.name, sizeof facts.name);
    copy_text(level2::moment_units(moment.moment), facts.unit, sizeof facts.unit);
    facts.gates = moment.gate_stride;
    facts.first_gate_m = moment.first_gate_m;
    facts.gate_spacing_m = moment.gate_spacing_m;
    facts.code_bytes = moment.word_size_bits / 8;
    facts.first_valid_code = level2::facts_of(moment.moment).first_valid_code;
    facts.scale = moment.scale;
    facts.offset = moment.offset;
    return give(facts, to);
}

// Checks the room that the caller has for all gates.
Status check_count(const level2::SweepMoment& moment, const void* to, std::size_t count) {
    const std::size_t gates =
        moment.gate_counts.size() * static_cast<std::size_t>(moment.gate_stride);
    if (count != gates)
        return fail(ErrorCode::bad_argument, "count is {}; there are {} gates", count, gates);
    if (to == nullptr && gates > 0) return is_null("the array");
    return {};
}

// Writes result_of(code) for each gate, and `beyond` for places beyond the gates of a radial.
template <class Value, class ResultOf>
void write_gates(const level2::SweepMoment& moment, Value beyond, Value* to, ResultOf result_of) {
    const auto write = [&](const auto& codes) {
        using Code = typename std::decay_t<decltype(codes)>::value_type;
        std::vector<Value> results(std::size_t{1} << (8 * sizeof(Code)));
        for (std::size_t code = 0; code < results.size(); ++code)
            results[code] = result_of(static_cast<std::uint16_t>(code));
        const auto stride = static_cast<std::size_t>(moment.gate_stride);
        for (std::size_t radial = 0; radial < moment.gate_counts.size(); ++radial) {
            const Code* const row = codes.data() + radial * stride;
            Value* const out = to + radial * stride;
            const std::size_t count = std::min<std::size_t>(moment.gate_counts[radial], stride);
            std::transform(row, row + count, out, [&](Code code) { return results[code]; });
            std::fill(out + count, out + stride, beyond);
        }
    };
    if (moment.word_size_bits == 8) {
        write(moment.codes8);
    } else {
        write(moment.codes16);
    }
}

}  // namespace

Result<const level2::Sweep*> sweep_of(const stormcellar_volume* volume, std::int32_t sweep) {
    if (volume == nullptr) return is_null("volume");
    const auto& sweeps = volume->source.volume.sweeps;
    if (sweep < 0 || static_cast<std::size_t>(sweep) >= sweeps.size())
        return fail(ErrorCode::bad_argument, "there is no sweep {}; there are {}", sweep,
                    sweeps.size());
    return &sweeps[static_cast<std::size_t>(sweep)];
}

Result<const level2::SweepMoment*> moment_of(const stormcellar_volume* volume, std::int32_t sweep,
                                             std::int32_t moment) {
    const auto found = sweep_of(volume, sweep);
    if (!found) return pass_on(found);
    const auto& moments = (*found)->moments;
    if (moment < 0 || static_cast<std::size_t>(moment) >= moments.size())
        return fail(ErrorCode::bad_argument, "sweep {} has no moment {}; it has {}", sweep, moment,
                    moments.size());
    return &moments[static_cast<std::size_t>(moment)];
}

}  // namespace stormcellar::capi

using namespace stormcellar;

stormcellar_code stormcellar_sweep_describe(const stormcellar_volume* volume, int32_t sweep,
                                            stormcellar_sweep_facts* facts,
                                            stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        const auto found = capi::sweep_of(volume, sweep);
        if (!found) return pass_on(found);
        return capi::describe_sweep(**found, facts);
    });
}

stormcellar_code stormcellar_sweep_radials(const stormcellar_volume* volume, int32_t sweep,
                                           stormcellar_radial* radials, size_t count,
                                           stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        const auto found = capi::sweep_of(volume, sweep);
        if (!found) return pass_on(found);
        const auto& all = (*found)->radials;
        if (count != all.size())
            return fail(ErrorCode::bad_argument, "count is {}; there are {} radials", count,
                        all.size());
        if (radials == nullptr && count > 0) return capi::is_null("radials");
        std::ranges::transform(all, radials, [](const level2::Radial& radial) {
            return stormcellar_radial{capi::milliseconds_of(radial.time),
                                      radial.azimuth_deg,
                                      radial.elevation_deg,
                                      radial.nyquist_mps,
                                      radial.unambiguous_range_m,
                                      radial.status,
                                      radial.azimuth_number};
        });
        return {};
    });
}

stormcellar_code stormcellar_moment_describe(const stormcellar_volume* volume, int32_t sweep,
                                             int32_t moment, stormcellar_moment_facts* facts,
                                             stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        const auto found = capi::moment_of(volume, sweep, moment);
        if (!found) return pass_on(found);
        return capi::describe_moment(**found, facts);
    });
}

stormcellar_code stormcellar_moment_find(const stormcellar_volume* volume, int32_t sweep,
                                         const char* name, int32_t* moment,
                                         stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        const auto found = capi::sweep_of(volume, sweep);
        if (!found) return pass_on(found);
        if (name == nullptr || moment == nullptr)
            return capi::is_null(name == nullptr ? "name" : "moment");
        const auto& all = (*found)->moments;
        const auto place = std::ranges::find_if(all, [&](const level2::SweepMoment& one) {
            return level2::moment_name(one.moment) == name;
        });
        if (place == all.end())
            return fail(ErrorCode::not_found, "sweep {} has no moment '{}'", sweep, name);
        *moment = static_cast<std::int32_t>(place - all.begin());
        return {};
    });
}

stormcellar_code stormcellar_moment_codes(const stormcellar_volume* volume, int32_t sweep,
                                          int32_t moment, const void** codes,
                                          stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        const auto found = capi::moment_of(volume, sweep, moment);
        if (!found) return pass_on(found);
        if (codes == nullptr) return capi::is_null("codes");
        const level2::SweepMoment& one = **found;
        *codes = one.word_size_bits == 8 ? static_cast<const void*>(one.codes8.data())
                                         : static_cast<const void*>(one.codes16.data());
        return {};
    });
}

stormcellar_code stormcellar_moment_values(const stormcellar_volume* volume, int32_t sweep,
                                           int32_t moment, float* values, size_t count,
                                           stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        const auto found = capi::moment_of(volume, sweep, moment);
        if (!found) return pass_on(found);
        const level2::SweepMoment& one = **found;
        if (Status fits = capi::check_count(one, values, count); !fits) return fits;
        constexpr float none = std::numeric_limits<float>::quiet_NaN();
        capi::write_gates(one, none, values, [&](std::uint16_t code) {
            return level2::status_of_code(one.moment, code) == level2::GateStatus::valid
                       ? one.value_of(code)
                       : none;
        });
        return {};
    });
}

stormcellar_code stormcellar_moment_states(const stormcellar_volume* volume, int32_t sweep,
                                           int32_t moment, uint8_t* states, size_t count,
                                           stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        const auto found = capi::moment_of(volume, sweep, moment);
        if (!found) return pass_on(found);
        const level2::SweepMoment& one = **found;
        if (Status fits = capi::check_count(one, states, count); !fits) return fits;
        capi::write_gates<std::uint8_t>(
            one, STORMCELLAR_GATE_NO_DATA, states, [&](std::uint16_t code) {
                return static_cast<std::uint8_t>(level2::status_of_code(one.moment, code));
            });
        return {};
    });
}
