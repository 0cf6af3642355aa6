#include "level2/sweep_builder.h"

#include <algorithm>
#include <cstring>

#include "base/station_table.h"

namespace stormcellar::level2 {
namespace {

// Rows to make room for, so that arrays of an ordinary sweep are never moved or too large.
constexpr std::size_t radials_half_degree = 720;
constexpr std::size_t radials_one_degree = 368;
constexpr std::size_t reserve_limit_bytes = std::size_t{4} << 20;
// Real sweeps hold one or two kinds of a moment.
constexpr std::ptrdiff_t most_kinds_of_a_moment = 16;

VcpSource source_of(const Vcp& vcp) {
    return vcp.message_type == 7 ? VcpSource::message_7 : VcpSource::message_5;
}

bool begins_sweep(const Radial& radial) {
    const RadialStatus status = status_of(radial);
    return status == RadialStatus::start_of_elevation || status == RadialStatus::start_of_volume ||
           status == RadialStatus::start_of_last_elevation;
}

std::size_t expected_radials(float azimuth_spacing_deg) {
    return azimuth_spacing_deg == 0.5F ? radials_half_degree : radials_one_degree;
}

std::size_t bytes_per_code(const SweepMoment& moment) {
    return moment.word_size_bits == 8 ? 1 : 2;
}

std::uint64_t bytes_per_row(const SweepMoment& moment, std::int32_t stride) {
    return sizeof(std::uint16_t) + static_cast<std::uint64_t>(stride) * bytes_per_code(moment);
}

// Calls the function with the array of codes that is in use.
template <class Function>
void with_codes(SweepMoment& moment, Function function) {
    if (moment.word_size_bits == 8) {
        function(moment.codes8);
    } else {
        function(moment.codes16);
    }
}

// Gives the rows another length; codes beyond the new length are dropped, new ones are 0.
void set_stride(SweepMoment& moment, std::int32_t stride) {
    const auto from = static_cast<std::size_t>(moment.gate_stride);
    const auto to = static_cast<std::size_t>(stride);
    with_codes(moment, [&](auto& codes) {
        std::remove_reference_t<decltype(codes)> moved(moment.gate_counts.size() * to);
        for (std::size_t row = 0; row < moment.gate_counts.size(); ++row) {
            const auto begin = codes.begin() + static_cast<std::ptrdiff_t>(row * from);
            std::copy(begin, begin + static_cast<std::ptrdiff_t>(std::min(from, to)),
                      moved.begin() + static_cast<std::ptrdiff_t>(row * to));
        }
        codes = std::move(moved);
    });
    moment.gate_stride = stride;
}

// Rows of no gates for radials that lack the moment.
void pad_rows(SweepMoment& moment, std::size_t rows) {
    if (moment.gate_counts.size() >= rows) return;
    moment.gate_counts.resize(rows);
    with_codes(moment, [&](auto& codes) {
        codes.resize(rows * static_cast<std::size_t>(moment.gate_stride));
    });
}

void append_row(SweepMoment& moment, const MomentBlock& block) {
    const auto stride = static_cast<std::size_t>(moment.gate_stride);
    const std::size_t row = moment.gate_counts.size() * stride;
    moment.gate_counts.push_back(block.gates);
    if (moment.word_size_bits == 8) {
        const auto* codes = reinterpret_cast<const std::uint8_t*>(block.codes.data());
        moment.codes8.insert(moment.codes8.end(), codes, codes + block.gates);
        moment.codes8.resize(row + stride);
        return;
    }
    moment.codes16.resize(row + stride);
    const std::byte* from = block.codes.data();
    for (std::size_t gate = 0; gate < block.gates; ++gate, from += 2) {
        moment.codes16[row + gate] = static_cast<std::uint16_t>(
            (std::to_integer<unsigned>(from[0]) << 8) | std::to_integer<unsigned>(from[1]));
    }
}

void release_unused(SweepMoment& moment) {
    const auto largest = *std::max_element(moment.gate_counts.begin(), moment.gate_counts.end());
    if (largest < moment.gate_stride) set_stride(moment, largest);
    with_codes(moment, [](auto& codes) {
        if (codes.capacity() - codes.size() > codes.size() / 8) codes.shrink_to_fit();
    });
}

bool same_kind(const SweepMoment& moment, const MomentBlock& block) {
    return moment.moment == block.moment && moment.first_gate_m == block.first_gate_m &&
           moment.gate_spacing_m == block.gate_spacing_m &&
           moment.word_size_bits == block.word_size_bits && moment.scale == block.scale &&
           moment.offset == block.offset;
}

}  // namespace

bool SweepBuilder::take(std::uint64_t bytes) {
    if (bytes > limit_bytes_ - taken_bytes_) return false;
    taken_bytes_ += bytes;
    return true;
}

void SweepBuilder::set_vcp(Vcp vcp) {
    if (!volume_.vcp_message) {
        volume_.vcp_message = vcp;
        volume_.vcp = vcp.pattern_number;
        volume_.vcp_source = source_of(vcp);
    }
    current_vcp_ = std::move(vcp);
    vcp_is_new_ = true;
}

// What is known of the pattern of a volume that begins with this radial. An old message 5 counts
// only as long as the radials name its pattern.
DecodeReport::FurtherPattern SweepBuilder::pattern_of(const RadialMessage& message) {
    const int named = message.vcp.value_or(0);
    if (current_vcp_ && !vcp_is_new_ && named != 0 && named != current_vcp_->pattern_number) {
        current_vcp_.reset();
    }
    DecodeReport::FurtherPattern pattern{volume_.sweeps.size(), current_vcp_, {}, VcpSource::none};
    if (current_vcp_) {
        pattern.vcp = current_vcp_->pattern_number;
        pattern.source = source_of(*current_vcp_);
    } else if (named != 0) {
        pattern.vcp = named;
        pattern.source = VcpSource::radial;
    }
    return pattern;
}

void SweepBuilder::further_header(const VolumeHeader& header) {
    pending_header_ = header;
}

void SweepBuilder::note_station(const RadialMessage& message) {
    if (message_station_.empty() && is_icao(message.icao)) message_station_ = message.icao;
    if (!volume_.block && !message.volume_block.empty()) {
        volume_.block = read_volume_block(message.volume_block);
    }
    if (!volume_.vcp && message.vcp && *message.vcp != 0) {
        volume_.vcp = *message.vcp;
        volume_.vcp_source = VcpSource::radial;
    }
}

bool SweepBuilder::begins_volume(const RadialMessage& message) const {
    if (volume_.sweeps.empty()) return false;
    if (status_of(message.radial) == RadialStatus::start_of_volume || pending_header_) return true;
    // A pattern's cuts only count upwards, so a lower number is another pass, even where the
    // radials that would say so are lost.
    const int previous = volume_.sweeps.back().elevation_number;
    return message.elevation_number < previous ||
           (volume_ended_ && message.elevation_number == previous);
}

void SweepBuilder::begin_sweep(const RadialMessage& message) {
    if (begins_volume(message)) {
        volume_starts_.push_back(volume_.sweeps.size());
        further_patterns_.push_back(pattern_of(message));
        if (pending_header_) {
            further_headers_.push_back({volume_.sweeps.size(), *pending_header_});
        }
    }
    pending_header_.reset();
    vcp_is_new_ = false;
    end_sweep();
    Sweep& sweep = volume_.sweeps.emplace_back();
    sweep.elevation_number = message.elevation_number;
    sweep.message_type = message.message_type;
    sweep.azimuth_spacing_deg = message.azimuth_spacing_deg;
    const auto cut = static_cast<std::size_t>(message.elevation_number) - 1;
    if (message.elevation_number >= 1 && current_vcp_ && cut < current_vcp_->cuts.size()) {
        sweep.vcp_elevation_deg = current_vcp_->cuts[cut].elevation_deg;
    }
    sweep.radials.reserve(expected_radials(message.azimuth_spacing_deg));
}

void SweepBuilder::end_sweep() {
    if (volume_.sweeps.empty()) return;
    Sweep& sweep = volume_.sweeps.back();
    for (SweepMoment& moment : sweep.moments) {
        pad_rows(moment, sweep.radials.size());
        release_unused(moment);
    }
    if (sweep.radials.capacity() > 2 * sweep.radials.size()) sweep.radials.shrink_to_fit();
}

SweepMoment* SweepBuilder::find_kind(Sweep& sweep, const MomentBlock& block) {
    for (SweepMoment& moment : sweep.moments) {
        if (same_kind(moment, block)) return &moment;
    }
    return nullptr;
}

// Room is made for the first kind of a moment: another one is rare and most often short.
SweepMoment& SweepBuilder::begin_kind(Sweep& sweep, const MomentBlock& block) {
    const bool first = sweep.find(block.moment) == nullptr;
    SweepMoment& moment = sweep.moments.emplace_back();
    moment.moment = block.moment;
    moment.first_gate_m = block.first_gate_m;
    moment.gate_spacing_m = block.gate_spacing_m;
    moment.gate_stride = block.gates;
    moment.word_size_bits = block.word_size_bits;
    moment.scale = block.scale;
    moment.offset = block.offset;
    moment.control_flags = block.control_flags;
    moment.snr_threshold_db = block.snr_threshold_db;
    moment.folding_threshold_db = block.folding_threshold_db;
    if (!first) return moment;
    const std::size_t rows = expected_radials(sweep.azimuth_spacing_deg);
    const std::size_t most = reserve_limit_bytes / bytes_per_code(moment);
    moment.gate_counts.reserve(rows);
    with_codes(moment, [&](auto& codes) { codes.reserve(std::min(rows * block.gates, most)); });
    return moment;
}

// Adds the row of the sweep's newest radial. Its bytes are taken already where the kind was there.
bool SweepBuilder::add_moment(Sweep& sweep, const MomentBlock& block) {
    const std::size_t rows = sweep.radials.size();
    SweepMoment* moment = find_kind(sweep, block);
    if (moment == nullptr) {
        moment = &begin_kind(sweep, block);
        if (!take(rows * bytes_per_row(*moment, moment->gate_stride))) return false;
    }
    if (block.gates > moment->gate_stride) {
        // By a quarter at least, so that ever longer radials are not copied ever again; the end of
        // the sweep takes the surplus back.
        const std::int32_t stride =
            std::max<std::int32_t>(block.gates, moment->gate_stride + moment->gate_stride / 4);
        const auto more = static_cast<std::uint64_t>(stride - moment->gate_stride);
        if (!take(rows * more * bytes_per_code(*moment))) return false;
        set_stride(*moment, stride);
    }
    pad_rows(*moment, rows - 1);
    append_row(*moment, block);
    return true;
}

bool SweepBuilder::has_too_many_kinds(const Sweep& sweep, const RadialMessage& message) {
    for (const MomentBlock& block : message.moments()) {
        const auto same_moment = [&](const SweepMoment& m) { return m.moment == block.moment; };
        const auto kinds = std::count_if(sweep.moments.begin(), sweep.moments.end(), same_moment);
        const bool known = std::any_of(sweep.moments.begin(), sweep.moments.end(),
                                       [&](const SweepMoment& m) { return same_kind(m, block); });
        if (!known && kinds >= most_kinds_of_a_moment) return true;
    }
    return false;
}

// A radial's row in every kind of its sweep: those that it lacks are padded at the end.
std::uint64_t SweepBuilder::row_bytes(const Sweep& sweep) {
    std::uint64_t bytes = 0;
    for (const SweepMoment& moment : sweep.moments)
        bytes += bytes_per_row(moment, moment.gate_stride);
    return bytes;
}

SweepBuilder::Added SweepBuilder::add(const RadialMessage& message) {
    const bool first_of_sweep =
        volume_.sweeps.empty() || begins_sweep(message.radial) || pending_header_ ||
        volume_.sweeps.back().elevation_number != message.elevation_number ||
        volume_.sweeps.back().message_type != message.message_type;
    if (!first_of_sweep && has_too_many_kinds(volume_.sweeps.back(), message)) {
        return Added::refused;
    }
    const std::uint64_t bytes = first_of_sweep ? sizeof(Sweep) : row_bytes(volume_.sweeps.back());
    if (!take(sizeof(Radial) + bytes)) return Added::full;
    if (first_of_sweep) begin_sweep(message);
    note_station(message);
    volume_ended_ = status_of(message.radial) == RadialStatus::end_of_volume;
    Sweep& sweep = volume_.sweeps.back();
    sweep.radials.push_back(message.radial);
    for (const MomentBlock& block : message.moments()) {
        if (!add_moment(sweep, block)) return Added::full;
    }
    return Added::added;
}

Volume SweepBuilder::finish(DecodeReport& report) {
    end_sweep();
    report.further_volume_starts = std::move(volume_starts_);
    report.further_headers = std::move(further_headers_);
    report.further_patterns = std::move(further_patterns_);
    report.message_station = message_station_;
    report.complete = volume_ended_ && report.bytes_dropped == 0;
    volume_.station = std::move(message_station_);
    return std::move(volume_);
}

}  // namespace stormcellar::level2
