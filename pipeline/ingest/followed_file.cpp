#include "pipeline/ingest/followed_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/beneath.h"
#include "level2/containers/archive_header.h"
#include "level2/containers/content.h"
#include "pipeline/options/ingest_options.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/level2/live_chunk.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t stretch_bytes = std::size_t{256} << 10;
constexpr std::uint64_t most_records = 10'000;
// A longer last record is not examined. The largest known record has half a megabyte, and five
// megabytes unpacked.
constexpr std::uint64_t most_last_record_bytes = std::uint64_t{2} << 20;
constexpr std::uint64_t most_last_record_output = std::uint64_t{16} << 20;

class OpenFile {
  public:
    OpenFile(const fs::path& path, const fs::path& beneath)
        : opened_(open_beneath(beneath, path)), descriptor_(opened_ ? *opened_ : -1) {}
    [[nodiscard]] bool is_open() const { return descriptor_.is_open(); }
    [[nodiscard]] const Error& failure() const { return opened_.error(); }
    // Returns none if it is not a regular file.
    [[nodiscard]] std::optional<struct stat> facts() const {
        struct stat found {};
        if (::fstat(descriptor_.number(), &found) != 0 || !S_ISREG(found.st_mode))
            return std::nullopt;
        return found;
    }
    // Reads the bytes that are there, up to the size of the buffer.
    [[nodiscard]] std::size_t read(std::uint64_t at, std::span<std::byte> into) const {
        std::size_t done = 0;
        while (done < into.size()) {
            const ssize_t got = ::pread(descriptor_.number(), into.data() + done,
                                        into.size() - done, static_cast<off_t>(at + done));
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) break;
            done += static_cast<std::size_t>(got);
        }
        return done;
    }

  private:
    Result<int> opened_;
    Descriptor descriptor_;
};

std::int32_t control_word(std::span<const std::byte, 4> bytes) {
    std::uint32_t value = 0;
    for (const std::byte byte : bytes)
        value = value << 8U | std::to_integer<std::uint32_t>(byte);
    return static_cast<std::int32_t>(value);
}

struct RecordChain {
    // True if the last record has come, or if the file is not a file of records.
    bool is_whole = false;
    // Start of the last record, if the file ends where the record ends; 0 if the file ends within a
    // record.
    std::uint64_t last = 0;
};

RecordChain chain_of(const OpenFile& file, std::uint64_t size) {
    std::uint64_t at = level2::archive_header_bytes;
    for (std::uint64_t record = 0; record < most_records; ++record) {
        std::array<std::byte, 4> word{};
        if (at + 4 > size || file.read(at, word) < 4) return {};
        const std::uint64_t begin = at;
        const std::int64_t length = control_word(word);
        at += 4 + static_cast<std::uint64_t>(std::abs(length));
        if (at > size) return {};
        if (length == 0 || (length < 0 && at == size)) return {true, 0};
        if (at == size) return {false, begin};
    }
    return {true, 0};
}

// Returns true if the record from `begin` to the end of the file holds the last radial of a volume.
bool ends_volume(const OpenFile& file, std::uint64_t begin, std::uint64_t size) {
    if (size - begin > most_last_record_bytes) return false;
    std::vector<std::byte> record(size - begin);
    if (file.read(begin, record) < record.size()) return false;
    level2::DecodeOptions options;
    options.output_limit_bytes = most_last_record_output;
    const auto read = level2::read_live_chunk(record, options,
                                              {most_last_record_output, most_last_record_output});
    return read && read->ended_volume;
}

}  // namespace

MomentSet moments_in(const level2::Sweep& sweep, const std::vector<level2::Moment>& moments) {
    MomentSet found;
    for (const level2::Moment moment : moments)
        found.set(static_cast<std::size_t>(moment),
                  sweep.find(level2::measured_moment(moment)) != nullptr);
    return found;
}

ShelvedVolume::Kept::Kept(const level2::Sweep& sweep, const std::vector<level2::Moment>& gridded)
    : moments(moments_in(sweep, gridded)), elevation_deg(sweep.mean_elevation_deg()) {
    for (const level2::SweepMoment& moment : sweep.moments)
        measured.set(static_cast<std::size_t>(moment.moment));
}

bool ShelvedVolume::is_lowest(double elevation_deg) const {
    return std::none_of(sweeps.begin(), sweeps.end(), [&](const auto& entry) {
        return entry.second.moments.any() &&
               entry.second.elevation_deg < elevation_deg - same_elevation_deg;
    });
}

// Ignores a lack of space, because the next volume's living grids can dealias the sweep again.
void ShelvedVolume::keep_dealiased(SweepKey key, const level2::Sweep& sweep) {
    const auto kept = sweeps.find(key);
    const auto place = places.find(key);
    if (kept == sweeps.end() || place == places.end()) return;
    const bool is_same = kept->second.elevation_deg == sweep.mean_elevation_deg();
    if (!is_same || sweep.find(level2::Moment::veld) == nullptr) return;
    (void)dealiased.keep(*shelf, key, place->second, sweep);
}

std::optional<FollowedFile::Growing> FollowedFile::growing(const fs::path& path,
                                                           const fs::path& beneath) {
    const OpenFile file(path, beneath);
    if (!file.is_open()) return std::nullopt;
    const auto facts = file.facts();
    if (!facts) return std::nullopt;
    std::array<std::byte, 64> start{};
    const std::size_t known = file.read(0, start);
    const std::span<const std::byte> head = std::span{start}.first(known);
    const auto header = level2::read_archive_header(head);
    if (!header) return std::nullopt;
    Growing growing{header->icao, 0};
    // Hardly more than the header has come. The header does not show what will follow, so the file
    // may be growing.
    if (known <= level2::archive_header_bytes + 16) return growing;
    if (level2::content_at_start(head) != level2::Content::ldm) return std::nullopt;
    const RecordChain chain = chain_of(file, static_cast<std::uint64_t>(facts->st_size));
    if (chain.is_whole) return std::nullopt;
    growing.last_record = chain.last;
    return growing;
}

bool FollowedFile::has_ended(const fs::path& path, const Growing& growing,
                             const fs::path& beneath) {
    if (growing.last_record == 0) return false;
    const OpenFile file(path, beneath);
    const auto facts = file.is_open() ? file.facts() : std::nullopt;
    return facts &&
           ends_volume(file, growing.last_record, static_cast<std::uint64_t>(facts->st_size));
}

FollowedFile::FollowedFile(fs::path path, const Options& options)
    : path_(std::move(path)),
      beneath_(options.beneath),
      moments_(options.moments),
      growing_(level2::DecodeOptions{.threads = 1,
                                     .output_limit_bytes = most_unpacked_bytes,
                                     .array_limit_bytes = most_array_bytes(options.selection),
                                     .open_sweep_limit_bytes = options.open_sweep_limit_bytes,
                                     .selection = options.selection,
                                     .fallback_station = options.fallback_station}),
      kept_(std::make_unique<ShelvedVolume>()) {
    growing_.set_dropped_sweeps(
        [this](std::size_t index) { return kept_->shelf->get(kept_->places.at(index)); });
}

Result<std::unique_ptr<FollowedFile>> FollowedFile::begin(const fs::path& path,
                                                          const Options& options) {
    auto shelf = SweepShelf::make_in(options.scratch);
    if (!shelf) return pass_on(shelf);
    std::unique_ptr<FollowedFile> file(new FollowedFile(path, options));
    file->kept_->shelf = std::move(*shelf);
    file->kept_->source_file = path.filename().string();
    return file;
}

Status FollowedFile::read_to(std::uint64_t size_bytes, const std::function<bool()>& may_read_on) {
    Status read = read_on(size_bytes, may_read_on);
    is_whole_ = is_whole_ && read.has_value();
    return read;
}

Status FollowedFile::read_on(std::uint64_t size_bytes, const std::function<bool()>& may_read_on) {
    const OpenFile file(path_, beneath_);
    if (!file.is_open()) return tl::unexpected<Error>(file.failure());
    const auto facts = file.facts();
    const std::uint64_t inode = facts ? facts->st_ino : 0;
    if (!facts || (read_bytes_ > 0 && inode != inode_) || size_bytes < read_bytes_) {
        return fail(ErrorCode::corrupt, "{}: was replaced by another file", path_.native());
    }
    inode_ = inode;
    std::vector<std::byte> buffer(std::min<std::uint64_t>(stretch_bytes, size_bytes - read_bytes_));
    while (read_bytes_ < size_bytes) {
        const std::size_t wanted = std::min<std::uint64_t>(buffer.size(), size_bytes - read_bytes_);
        const std::size_t got = file.read(read_bytes_, std::span{buffer}.first(wanted));
        if (got == 0)
            return fail(ErrorCode::io, "{}: became shorter while it was read", path_.native());
        if (Status taken = take(std::span{buffer}.first(got)); !taken) return taken;
        if (may_read_on && !may_read_on()) {
            return fail(ErrorCode::over_budget, "{}: needs more than its share of the memory",
                        path_.native());
        }
    }
    kept_->facts = growing_.facts();
    return {};
}

Status FollowedFile::take(std::span<const std::byte> bytes) {
    hash_.append(bytes);
    read_bytes_ += bytes.size();
    if (Status taken = growing_.append(bytes); !taken) return taken;
    if (read_bytes_ > 64 && !growing_.is_of_records()) {
        return fail(ErrorCode::unsupported, "{}: does not consist of LDM records", path_.native());
    }
    return shelve_new_sweeps();
}

Status FollowedFile::shelve_new_sweeps() {
    for (level2::LiveSweep& live : growing_.take_sweeps()) {
        const auto place = kept_->shelf->put(live.sweep);
        if (!place) return pass_on(place);
        kept_->places.insert_or_assign(live.index, *place);
        const ShelvedVolume::Kept kept(live.sweep, moments_);
        kept_->sweeps.insert_or_assign(live.index, kept);
        std::size_t& radials = radials_of_[live.index];
        radials_ += live.sweep.radials.size() - radials;
        radials = live.sweep.radials.size();
        if (level2::is_plausible(live.sweep.radials.back().time)) {
            newest_ = std::max(newest_.value_or(UtcTime{}), live.sweep.radials.back().time);
        }
        if (kept.moments.any()) news_.add(kept.moments, kept_->is_lowest(kept.elevation_deg));
        if (live.index < dropped_) growing_.drop_sweep(live.index);
    }
    for (; dropped_ < growing_.droppable_sweeps(); ++dropped_) {
        if (!kept_->places.contains(dropped_)) break;
        growing_.drop_sweep(dropped_);
    }
    return {};
}

Status FollowedFile::is_as_followed() const {
    const OpenFile file(path_, beneath_);
    if (!file.is_open()) return tl::unexpected<Error>(file.failure());
    Xxh3Stream hash;
    std::vector<std::byte> buffer(stretch_bytes);
    std::uint64_t done = 0;
    // Try to read one byte more than before. If that succeeds, the file has grown.
    while (done <= read_bytes_) {
        const std::size_t wanted = std::min<std::uint64_t>(buffer.size(), read_bytes_ + 1 - done);
        const std::size_t got = file.read(done, std::span{buffer}.first(wanted));
        if (got == 0) break;
        hash.append(std::span{buffer}.first(got));
        done += got;
    }
    if (done != read_bytes_ || hash.value() != hash_.value()) {
        return fail(ErrorCode::corrupt, "{}: was replaced by another file", path_.native());
    }
    return {};
}

Result<level2::Decoded> FollowedFile::finish() {
    if (Status same = is_as_followed(); !same) return pass_on(same);
    for (std::size_t index = 0; index < dropped_; ++index) {
        auto sweep = kept_->shelf->get(kept_->places.at(index));
        if (!sweep) return pass_on(sweep);
        growing_.put_back(index, std::move(*sweep));
    }
    auto decoded = growing_.finish();
    if (!decoded) return decoded;
    kept_->facts = decoded->volume;
    kept_->facts.sweeps.clear();
    // Put the last sweep on the shelf, because it is complete only now. Also put sweeps there whose
    // index changed when sweeps were put in order.
    for (std::size_t index = 0; index < decoded->volume.sweeps.size(); ++index) {
        const level2::Sweep& sweep = decoded->volume.sweeps[index];
        const auto before = kept_->sweeps.find(index);
        if (index < dropped_ && before->second.elevation_deg == sweep.mean_elevation_deg())
            continue;
        const auto place = kept_->shelf->put(sweep);
        if (!place) break;  // living grids of the next volume will lack these sweeps
        kept_->places.insert_or_assign(index, *place);
        kept_->sweeps.insert_or_assign(index, ShelvedVolume::Kept(sweep, moments_));
    }
    return decoded;
}

void FollowedFile::keep_dealiased(const level2::Volume& dealiased) {
    for (std::size_t index = 0; index < dealiased.sweeps.size(); ++index)
        kept_->keep_dealiased(index, dealiased.sweeps[index]);
}

}  // namespace stormcellar::pipeline
