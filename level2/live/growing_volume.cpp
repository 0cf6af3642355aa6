#include "stormcellar/level2/growing_volume.h"

#include <algorithm>
#include <new>
#include <set>
#include <utility>

#include "level2/containers/archive_header.h"
#include "level2/containers/content.h"
#include "level2/containers/ldm_framer.h"
#include "level2/decode/message_reader.h"
#include "level2/decode/part_decoder.h"
#include "level2/decode/volume_builder.h"

namespace stormcellar::level2 {
namespace {

// Bytes needed to recognize LDM records and compressed files, and to recognize messages.
constexpr std::size_t decide_container_bytes = archive_header_bytes + 16;
constexpr std::size_t decide_messages_bytes =
    archive_header_bytes + frame_bytes + sure_message_bytes;
// The longest record, plus two stretches.
constexpr std::size_t most_unframed_bytes = longest_record_bytes + (std::size_t{2} << 20);
// Bytes held before they are searched, if the start of the file is unknown.
constexpr std::size_t most_unknown_bytes = std::size_t{16} << 20;
constexpr std::size_t kept_bytes = std::size_t{16} << 10;

}  // namespace

class GrowingVolume::Reader {
  public:
    explicit Reader(DecodeOptions options) : options_(std::move(options)) {}
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    Status append(std::span<const std::byte> bytes);
    std::vector<LiveSweep> take_sweeps();
    Volume facts() const;
    bool has_ended() const;
    bool has_last_radial() const { return volume_.volume_has_ended(); }
    bool is_of_records() const { return kind_ == Kind::records; }
    bool holds_several() const { return !volume_.so_far_holds_one(); }
    std::uint64_t held_bytes() const {
        return volume_.held_bytes() + held_.capacity() + room_.taken_bytes();
    }
    std::size_t droppable_sweeps() const;
    void drop_sweep(std::size_t index) { volume_.drop_sweep(index); }
    void put_back(std::size_t index, Sweep sweep) { volume_.put_back(index, std::move(sweep)); }
    void set_dropped_sweeps(DroppedSweeps dropped) {
        volume_.set_dropped_sweeps(std::move(dropped));
    }
    Result<Decoded> finish();
    // Fails because the system has no more memory for this file.
    Status give_up() { return failed_ = no_memory(); }

  private:
    enum class Kind : std::uint8_t { undecided, records, messages, held };
    void decide();
    Status append_stretch(std::span<const std::byte> bytes);
    void note_late_radials();
    Status hold(std::span<const std::byte> bytes);
    Status look_through_unknown();
    Status read_records(bool last);
    Status read_messages(std::span<const std::byte> bytes, bool last);

    DecodeOptions options_;
    Kind kind_ = Kind::undecided;
    bool is_unknown_ = false;  // the held bytes begin with unknown content
    Status failed_;
    std::vector<std::byte> held_;  // bytes that are not consumed yet
    VolumeBuilder volume_{options_.output_limit_bytes, options_.most_array_bytes()};
    LdmStreamFramer framer_;
    bool last_is_negative_ = false;
    ArrayRoom room_{options_.most_array_bytes()};
    FragmentBuilder fragment_{room_, rows_of_a_stretch, options_.selection};
    MessageReader reader_{fragment_};
    MessageFeed feed_{reader_};
    std::size_t next_sweep_ = 0;      // sweeps below this index are closed and returned
    std::size_t radials_handed_ = 0;  // radials of sweep next_sweep_ when it was last returned
    std::set<std::size_t> changed_;   // sweeps that got late radials since the last take_sweeps()
};

void GrowingVolume::Reader::decide() {
    if (held_.size() < decide_container_bytes) return;
    const Content content = content_at_start(held_);
    const bool maybe_messages = content == Content::messages || content == Content::unknown;
    if (maybe_messages && held_.size() < decide_messages_bytes) return;
    kind_ = Kind::held;
    is_unknown_ = content == Content::unknown;
    if (content != Content::ldm && content != Content::messages) return;
    DecodeReport& report = volume_.report_data();
    const std::size_t header = held_.size() - volume_.begin_stream(held_).size();
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(header));
    if (content == Content::ldm) {
        kind_ = Kind::records;
        report.container = "ldm-bzip2";
        report.ldm_records = 0;
        report.negative_control_words = 0;
    } else {
        kind_ = Kind::messages;
        report.container = "uncompressed";
    }
}

Status GrowingVolume::Reader::read_records(bool last) {
    PartDecoder parts{options_.output_limit_bytes, options_.selection};
    std::size_t done = 0;
    while (const auto part = framer_.next(std::span{held_}.subspan(done), last)) {
        done += framer_.position() - part->position;
        if (part->kind == LdmPart::Kind::record) last_is_negative_ = part->negative;
        Fragment fragment = parts.decode(*part, ArrayRoom{volume_.arrays_left()});
        if (Status taken = volume_.append(std::move(fragment)); !taken) return taken;
        const std::uint64_t limit = options_.open_sweep_limit_bytes;
        if (limit > 0 && volume_.open_sweep_bytes() > limit)
            return fail(ErrorCode::over_budget, "a sweep takes more than {} bytes", limit);
    }
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(done));
    // Free unused memory, because many volumes grow at once. But keep the room of an unfinished
    // record, because moving the record with each stretch would take quadratic time.
    if (held_.capacity() > kept_bytes + 2 * held_.size()) held_.shrink_to_fit();
    return {};
}

Status GrowingVolume::Reader::read_messages(std::span<const std::byte> bytes, bool last) {
    feed_.append(bytes);
    if (last) feed_.end();
    const Fragment::Failure failure = reader_.failure();
    std::optional<Fragment> fragment = reader_.take_fragment();
    if (!fragment) {
        if (failure == Fragment::Failure::none) return {};
        fragment.emplace();
    }
    fragment->failure = failure;
    Status taken = volume_.append(std::move(*fragment));
    room_.set_limit(volume_.arrays_left());
    return taken;
}

Status GrowingVolume::Reader::look_through_unknown() {
    if (content_anywhere(held_) == Content::unknown) {
        return fail(ErrorCode::not_level2, "nothing in its first {} bytes is a record or a message",
                    held_.size());
    }
    is_unknown_ = false;
    return {};
}

Status GrowingVolume::Reader::hold(std::span<const std::byte> bytes) {
    if (is_unknown_ && held_.size() >= most_unknown_bytes) {
        if (Status known = look_through_unknown(); !known) return known;
    }
    if (kind_ == Kind::held && bytes.size() > most_packed_bytes - held_.size()) {
        return fail(ErrorCode::unsupported, "is a compressed file of more than {} bytes",
                    most_packed_bytes);
    }
    if (kind_ == Kind::records && bytes.size() > most_unframed_bytes - held_.size()) {
        return fail(ErrorCode::unsupported, "has {} bytes without the end of an LDM record",
                    most_unframed_bytes);
    }
    held_.insert(held_.end(), bytes.begin(), bytes.end());
    return {};
}

Status GrowingVolume::Reader::append_stretch(std::span<const std::byte> bytes) {
    const bool was_messages = kind_ == Kind::messages;
    if (!was_messages) {
        if (Status held = hold(bytes); !held) return held;
    }
    if (kind_ == Kind::undecided) decide();
    if (kind_ == Kind::records) return read_records(false);
    if (kind_ != Kind::messages) return {};
    Status taken = read_messages(was_messages ? bytes : std::span<const std::byte>{held_}, false);
    held_.clear();
    return taken;
}

Status GrowingVolume::Reader::append(std::span<const std::byte> bytes) {
    for (std::size_t at = 0; at < bytes.size() && failed_; at += stretch_bytes) {
        failed_ = append_stretch(bytes.subspan(at, std::min(stretch_bytes, bytes.size() - at)));
        note_late_radials();
    }
    return failed_;
}

// Drops sweeps again that were fetched only for a search, and notes the sweeps that got late
// radials.
void GrowingVolume::Reader::note_late_radials() {
    VolumeBuilder::Touched touched = volume_.take_touched();
    for (const std::size_t index : touched.fetched) {
        if (!changed_.contains(index)) volume_.drop_sweep(index);
    }
    changed_.merge(touched.changed);
}

std::vector<LiveSweep> GrowingVolume::Reader::take_sweeps() {
    std::vector<LiveSweep> taken;
    if (!failed_) return taken;  // the volume may be incomplete
    const std::size_t closed = volume_.closed_sweeps();
    std::uint64_t bytes = 0;
    const auto hand_out = [&](std::size_t index) {
        Sweep sweep = volume_.whole_sweep(index);
        bytes += bytes_of(sweep);
        radials_handed_ = sweep.radials.size();
        const bool whole = is_whole(sweep);
        taken.push_back({std::move(sweep), index, whole});
    };
    const auto& sweeps = volume_.so_far().sweeps;
    while (!changed_.empty() && bytes < most_live_bytes) {
        const std::size_t index = changed_.extract(changed_.begin()).value();
        if (index >= next_sweep_) continue;  // the loop below returns this sweep anyway
        const std::size_t handed = radials_handed_;
        hand_out(index);
        radials_handed_ = handed;
    }
    for (; next_sweep_ < closed && bytes < most_live_bytes; ++next_sweep_) {
        if (sweeps[next_sweep_].radials.size() != radials_handed_) hand_out(next_sweep_);
        radials_handed_ = 0;
    }
    if (next_sweep_ == closed && volume_.last_has_ended() && bytes < most_live_bytes) {
        const std::size_t count = sweeps[closed].radials.size();
        if (count > radials_handed_ + radials_handed_ / 4) hand_out(closed);
    }
    return taken;
}

// The last sweep is not droppable even if it is closed, because the next piece may read it.
std::size_t GrowingVolume::Reader::droppable_sweeps() const {
    const std::size_t count = volume_.so_far().sweeps.size();
    return std::min(next_sweep_, count == 0 ? 0 : count - 1);
}

Volume GrowingVolume::Reader::facts() const {
    return volume_.facts(options_.fallback_station);
}

bool GrowingVolume::Reader::has_ended() const {
    return volume_.volume_has_ended() || (last_is_negative_ && volume_.has_radials());
}

Result<Decoded> GrowingVolume::Reader::finish() {
    if (!failed_) return pass_on(failed_);
    switch (kind_) {
        case Kind::undecided:
        case Kind::held:
            return decode(held_, options_);
        case Kind::records:
            failed_ = read_records(true);
            break;
        case Kind::messages:
            failed_ = read_messages({}, true);
            break;
    }
    if (!failed_) return pass_on(failed_);
    return volume_.finish(options_.fallback_station);
}

GrowingVolume::GrowingVolume(DecodeOptions options)
    : reader_(std::make_unique<Reader>(std::move(options))) {}
GrowingVolume::GrowingVolume(GrowingVolume&&) noexcept = default;
GrowingVolume& GrowingVolume::operator=(GrowingVolume&&) noexcept = default;
GrowingVolume::~GrowingVolume() = default;

Status GrowingVolume::append(std::span<const std::byte> bytes) {
    try {
        return reader_->append(bytes);
    } catch (const std::bad_alloc&) {
        return reader_->give_up();
    }
}

std::vector<LiveSweep> GrowingVolume::take_sweeps() {
    try {
        return reader_->take_sweeps();
    } catch (const std::bad_alloc&) {
        (void)reader_->give_up();
        return {};
    }
}

Volume GrowingVolume::facts() const {
    return reader_->facts();
}

bool GrowingVolume::has_ended() const {
    return reader_->has_ended();
}

bool GrowingVolume::has_last_radial() const {
    return reader_->has_last_radial();
}

bool GrowingVolume::is_of_records() const {
    return reader_->is_of_records();
}

bool GrowingVolume::holds_several() const {
    return reader_->holds_several();
}

std::uint64_t GrowingVolume::held_bytes() const {
    return reader_->held_bytes();
}

std::size_t GrowingVolume::droppable_sweeps() const {
    return reader_->droppable_sweeps();
}

void GrowingVolume::drop_sweep(std::size_t index) {
    reader_->drop_sweep(index);
}

void GrowingVolume::put_back(std::size_t index, Sweep sweep) {
    reader_->put_back(index, std::move(sweep));
}

void GrowingVolume::set_dropped_sweeps(DroppedSweeps dropped) {
    reader_->set_dropped_sweeps(std::move(dropped));
}

Result<Decoded> GrowingVolume::finish() {
    try {
        return reader_->finish();
    } catch (const std::bad_alloc&) {
        return pass_on(reader_->give_up());
    }
}

}  // namespace stormcellar::level2
