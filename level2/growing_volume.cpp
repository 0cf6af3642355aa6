#include "level2/growing_volume.h"

#include <utility>

#include "level2/archive_header.h"
#include "level2/content.h"
#include "level2/ldm_framer.h"
#include "level2/message_reader.h"
#include "level2/part_decoder.h"
#include "level2/volume_builder.h"

namespace stormcellar::level2 {
namespace {

// Enough to tell LDM records and compressed files from the rest, and messages from anything.
constexpr std::size_t decide_container_bytes = archive_header_bytes + 16;
constexpr std::size_t decide_messages_bytes =
    archive_header_bytes + frame_bytes + sure_message_bytes;
constexpr std::size_t rows_of_a_stretch = 128;

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
    Result<Decoded> finish();

  private:
    enum class Kind : std::uint8_t { undecided, records, messages, held };
    void decide();
    Status hold(std::span<const std::byte> bytes);
    Status read_records(bool last);
    Status read_messages(std::span<const std::byte> bytes, bool last);

    DecodeOptions options_;
    Kind kind_ = Kind::undecided;
    Status failed_;
    std::vector<std::byte> held_;  // what is not yet done with
    VolumeBuilder volume_{options_.output_limit_bytes};
    LdmStreamFramer framer_;
    PartDecoder parts_{options_.output_limit_bytes, options_.selection};
    bool last_is_negative_ = false;
    FragmentBuilder fragment_{options_.output_limit_bytes, rows_of_a_stretch, options_.selection};
    MessageReader reader_{fragment_};
    MessageFeed feed_{reader_};
    std::vector<std::size_t> handed_out_;  // of each sweep: how many radials it had then
};

void GrowingVolume::Reader::decide() {
    if (held_.size() < decide_container_bytes) return;
    const Content content = content_at_start(held_);
    const bool maybe_messages = content == Content::messages || content == Content::unknown;
    if (maybe_messages && held_.size() < decide_messages_bytes) return;
    kind_ = Kind::held;
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
    std::size_t done = 0;
    while (const auto part = framer_.next(std::span{held_}.subspan(done), last)) {
        done += framer_.position() - part->position;
        if (part->kind == LdmPart::Kind::record) last_is_negative_ = part->negative;
        if (Status taken = volume_.append(parts_.decode(*part)); !taken) return taken;
    }
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(done));
    return {};
}

Status GrowingVolume::Reader::read_messages(std::span<const std::byte> bytes, bool last) {
    feed_.append(bytes);
    if (last) feed_.end();
    const bool full = reader_.full();
    std::optional<Fragment> fragment = reader_.take_fragment();
    if (!fragment) {
        if (!full) return {};
        fragment.emplace();
    }
    if (full) fragment->failure = Fragment::Failure::too_large_arrays;
    return volume_.append(std::move(*fragment));
}

Status GrowingVolume::Reader::hold(std::span<const std::byte> bytes) {
    if (bytes.size() > options_.output_limit_bytes - held_.size()) {
        return fail(ErrorCode::unsupported, "holds more than the limit of {} bytes",
                    options_.output_limit_bytes);
    }
    held_.insert(held_.end(), bytes.begin(), bytes.end());
    return {};
}

Status GrowingVolume::Reader::append(std::span<const std::byte> bytes) {
    if (!failed_) return failed_;
    const bool was_messages = kind_ == Kind::messages;
    if (!was_messages) failed_ = hold(bytes);
    if (failed_ && kind_ == Kind::undecided) decide();
    if (!failed_) return failed_;
    if (kind_ == Kind::records) failed_ = read_records(false);
    if (kind_ == Kind::messages) {
        failed_ = read_messages(was_messages ? bytes : std::span<const std::byte>{held_}, false);
        held_.clear();
    }
    return failed_;
}

std::vector<LiveSweep> GrowingVolume::Reader::take_sweeps() {
    std::vector<LiveSweep> closed;
    if (!failed_) return closed;  // what there is may be half done
    const std::size_t count = volume_.close_sweeps();
    handed_out_.resize(std::max(count, handed_out_.size()), 0);
    for (std::size_t i = 0; i < count; ++i) {
        const Sweep& sweep = volume_.so_far().sweeps[i];
        if (std::exchange(handed_out_[i], sweep.radials.size()) == sweep.radials.size()) continue;
        closed.push_back({sweep, i, is_whole(sweep)});
    }
    return closed;
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
    return reader_->append(bytes);
}
std::vector<LiveSweep> GrowingVolume::take_sweeps() {
    return reader_->take_sweeps();
}
Volume GrowingVolume::facts() const {
    return reader_->facts();
}
bool GrowingVolume::has_ended() const {
    return reader_->has_ended();
}
Result<Decoded> GrowingVolume::finish() {
    return reader_->finish();
}

}  // namespace stormcellar::level2
