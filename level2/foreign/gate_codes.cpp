#include "level2/foreign/gate_codes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stormcellar::level2 {
namespace {

using arrayfile::ElementKind;
using arrayfile::Elements;

constexpr std::int64_t greatest_code = 65'535;
constexpr std::int64_t greatest_short_code = 255;
constexpr std::int64_t folded_code = 1;
constexpr std::int64_t not_measured = -1;
constexpr double longest_gate_m = 100'000;
// The status variables of this program's files add this number to flags.
constexpr int first_filter_flag = 16;

bool is_integer(const Elements& elements) {
    return elements.type().is_number() && elements.type().kind != ElementKind::floating;
}

bool is_one_of(const std::vector<double>& marks, double element) {
    return std::ranges::find(marks, element) != marks.end();
}

bool is_mark(const MomentSource& source, double element) {
    return is_one_of(source.missing, element) || is_one_of(source.below, element);
}

struct Span {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -std::numeric_limits<double>::infinity();
};

// Returns the range of values that elements of this type can have.
std::optional<Span> span_of_type(const MomentSource& source, const Elements& elements) {
    const std::size_t size = elements.type().size;
    if (elements.type().kind != ElementKind::unsigned_integer || size > 2) return std::nullopt;
    Span span{0, size == 1 ? 255.0 : 65'535.0};
    while (span.least < span.greatest && is_mark(source, span.least))
        ++span.least;
    while (span.least < span.greatest && is_mark(source, span.greatest))
        --span.greatest;
    return span;
}

Span span_of(const MomentSource& source, const Elements& elements) {
    Span span;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const double element = elements[i];
        if (is_mark(source, element)) continue;
        span.least = std::min(span.least, element);
        span.greatest = std::max(span.greatest, element);
    }
    return span;
}

std::optional<Packing> exact_packing(const MomentSource& source, const Span& span) {
    const double first = facts_of(source.moment).first_valid_code;
    const double shift = std::max(0.0, first - span.least);
    const double top = span.greatest + shift;
    if (!(top <= static_cast<double>(greatest_code))) return std::nullopt;
    Packing packing;
    packing.shift = static_cast<std::int64_t>(shift);
    packing.scale = static_cast<float>(1 / source.gain);
    packing.offset = static_cast<float>(shift - source.offset / source.gain);
    packing.word_size_bits = top <= static_cast<double>(greatest_short_code) ? 8 : 16;
    constexpr float most = 1e9F;  // a damaged file may have any gain
    const bool is_sound = std::isgreater(packing.scale, 1 / most) &&
                          std::isless(packing.scale, most) &&
                          std::isless(std::abs(packing.offset), most);
    return is_sound ? std::optional{packing} : std::nullopt;
}

Packing stepped_packing(Moment moment) {
    Packing packing;
    packing.is_exact = false;
    packing.scale = moment == Moment::rho ? 10'000.0F : 100.0F;
    packing.offset = moment == Moment::phi ? 20'000.0F : 32'768.0F;  // PHI: from -200 degrees on
    packing.word_size_bits = 16;
    return packing;
}

// Turns elements into codes.
class Coder {
  public:
    Coder(const MomentSource& source, const Packing& packing, const Elements& elements,
          const Elements* states)
        : source_(source), packing_(packing), elements_(elements), states_(states) {
        is_float_ = elements.type().kind == ElementKind::floating && elements.type().size == 4;
        greatest_ = packing.word_size_bits == 8 ? greatest_short_code : greatest_code;
    }

    std::int64_t code(std::size_t at) {
        if (states_ != nullptr) {
            const int state = static_cast<int>((*states_)[at]);
            if (state == static_cast<int>(GateStatus::below_threshold)) return 0;
            if (state == static_cast<int>(GateStatus::no_data)) return not_measured;
            if (state >= first_filter_flag) return std::min(state - first_filter_flag, 7);
            if (state != static_cast<int>(GateStatus::valid)) return folded_code;
        }
        const double element = elements_[at];
        if (std::isnan(element) || is_marked(source_.below, element)) return 0;
        if (is_marked(source_.missing, element)) return not_measured;
        const double code = packing_.is_exact
                                ? element + static_cast<double>(packing_.shift)
                                : std::round((element * source_.gain + source_.offset) *
                                                 static_cast<double>(packing_.scale) +
                                             static_cast<double>(packing_.offset));
        const double first = facts_of(source_.moment).first_valid_code;
        if (code >= first && code <= static_cast<double>(greatest_))
            return static_cast<std::int64_t>(code);
        ++beyond;
        return not_measured;
    }

    std::uint64_t beyond = 0;

  private:
    [[nodiscard]] bool is_marked(const std::vector<double>& marks, double element) const {
        // The attributes of an array of floats may be doubles, which have more digits.
        return std::ranges::any_of(marks, [&](double mark) {
            return mark == element ||
                   (is_float_ && static_cast<float>(mark) == static_cast<float>(element));
        });
    }

    const MomentSource& source_;
    const Packing& packing_;
    const Elements& elements_;
    const Elements* states_;
    bool is_float_ = false;
    std::int64_t greatest_ = 0;
};

// Gates of a whole number of meters, and the gate of the file that each one takes.
struct WholeGates {
    std::int32_t first_m = 0, spacing_m = 0;
    std::vector<std::size_t> from;
};

Result<WholeGates> whole_gates(const MomentSource& source, std::size_t count) {
    const double spacing_m = source.gate_spacing_m, first_m = source.first_gate_m;
    if (!(spacing_m >= 0.5 && spacing_m <= longest_gate_m) ||
        !(std::abs(first_m) <= 100 * longest_gate_m))
        return fail(ErrorCode::corrupt, "the gates of {} are {} m long and begin at {} m",
                    moment_name(source.moment), spacing_m, first_m);
    WholeGates gates;
    gates.first_m = static_cast<std::int32_t>(std::lround(first_m));
    gates.spacing_m = static_cast<std::int32_t>(std::lround(spacing_m));
    constexpr double same_m = 1e-4;
    const bool is_whole = std::abs(spacing_m - gates.spacing_m) < same_m;
    for (std::size_t i = 0;; ++i) {
        const double at = static_cast<double>(i) * gates.spacing_m;
        const double from = is_whole ? static_cast<double>(i) : std::round(at / spacing_m);
        if (from >= static_cast<double>(count)) break;
        gates.from.push_back(static_cast<std::size_t>(from));
    }
    if (gates.from.size() > std::numeric_limits<std::uint16_t>::max())
        return fail(ErrorCode::unsupported, "{} has {} gates in a radial; the most is 65,535",
                    moment_name(source.moment), gates.from.size());
    return gates;
}

// The codes of a sweep, a row for each radial, with `not_measured` where there is no measurement.
struct Codes {
    std::size_t stride = 0;
    std::vector<std::int32_t> all;
    std::vector<std::size_t> ends;  // per radial: behind the last measured gate
    std::size_t begin = 0;          // first gate that any radial measured
    bool has_values = false;
};

Codes code_rows(const MomentSource& source, const WholeGates& gates, Coder& coder) {
    const std::int64_t first_valid = facts_of(source.moment).first_valid_code;
    Codes codes;
    codes.stride = gates.from.size();
    codes.all.assign(codes.stride * source.rows.size(), not_measured);
    codes.begin = codes.stride;
    for (std::size_t row = 0; row < source.rows.size(); ++row) {
        const GateRow& place = source.rows[row];
        std::size_t end = 0;
        for (std::size_t gate = 0; gate < codes.stride && gates.from[gate] < place.gates; ++gate) {
            const std::int64_t code = coder.code(place.first + gates.from[gate] * source.step);
            if (code == not_measured) continue;
            codes.all[row * codes.stride + gate] = static_cast<std::int32_t>(code);
            codes.has_values = codes.has_values || code >= first_valid;
            codes.begin = std::min(codes.begin, gate);
            end = gate + 1;
        }
        codes.ends.push_back(end);
    }
    return codes;
}

// Copies the codes from the first measured gate on.
void fill_moment(const Codes& codes, SweepMoment& moment, std::uint64_t& gaps) {
    const std::size_t longest = *std::ranges::max_element(codes.ends);
    const std::size_t stride = longest - codes.begin;
    moment.gate_stride = static_cast<std::int32_t>(stride);
    moment.first_gate_m += static_cast<std::int32_t>(codes.begin) * moment.gate_spacing_m;
    const bool is_short = moment.word_size_bits == 8;
    if (is_short)
        moment.codes8.assign(stride * codes.ends.size(), 0);
    else
        moment.codes16.assign(stride * codes.ends.size(), 0);
    for (std::size_t row = 0; row < codes.ends.size(); ++row) {
        const std::size_t end = codes.ends[row];
        moment.gate_counts.push_back(static_cast<std::uint16_t>(end == 0 ? 0 : end - codes.begin));
        for (std::size_t gate = codes.begin; gate < end; ++gate) {
            std::int64_t code = codes.all[row * codes.stride + gate];
            if (code == not_measured) {
                ++gaps;
                code = folded_code;
            }
            const std::size_t at = row * stride + gate - codes.begin;
            if (is_short)
                moment.codes8[at] = static_cast<std::uint8_t>(code);
            else
                moment.codes16[at] = static_cast<std::uint16_t>(code);
        }
    }
}

}  // namespace

Packing choose_packing(const MomentSource& source, const Elements& elements) {
    if (source.packing) {
        const MomentSource::KnownPacking& known = *source.packing;
        return {true, 0, known.scale, known.offset, known.word_size_bits};
    }
    if (!is_integer(elements) || !(source.gain > 0)) return stepped_packing(source.moment);
    if (const auto span = span_of_type(source, elements)) {
        if (const auto packing = exact_packing(source, *span)) return *packing;
    }
    return exact_packing(source, span_of(source, elements))
        .value_or(stepped_packing(source.moment));
}

Result<PackedMoment> pack_gates(const MomentSource& source, const Packing& packing,
                                const Elements& elements, const Elements* states) {
    std::size_t longest = 0;
    const std::size_t count =
        states == nullptr ? elements.size() : std::min(elements.size(), states->size());
    for (const GateRow& row : source.rows) {
        longest = std::max<std::size_t>(longest, row.gates);
        const std::size_t last = row.gates == 0 ? 0 : (row.gates - 1) * source.step;
        if (row.gates > 0 && (row.first >= count || last >= count - row.first))
            return fail(ErrorCode::corrupt, "radials have more gates than {} has elements",
                        moment_name(source.moment));
    }
    PackedMoment packed;
    const auto gates = whole_gates(source, longest);
    if (!gates) return pass_on(gates);
    Coder coder{source, packing, elements, states};
    const Codes codes = code_rows(source, *gates, coder);
    packed.beyond = coder.beyond;
    if (codes.begin == codes.stride) return packed;
    if (source.is_left_out_if_empty && !codes.has_values) return packed;
    SweepMoment moment;
    moment.moment = source.moment;
    moment.first_gate_m = gates->first_m;
    moment.gate_spacing_m = gates->spacing_m;
    moment.word_size_bits = packing.word_size_bits;
    moment.scale = packing.scale;
    moment.offset = packing.offset;
    fill_moment(codes, moment, packed.gaps);
    packed.moment = std::move(moment);
    return packed;
}

}  // namespace stormcellar::level2
