#include "pipeline/keep/sweep_shelf.h"

#include <cerrno>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <lz4.h>
#include <unistd.h>

#include "base/system_error.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::pipeline {
namespace {

using level2::Sweep;
using level2::SweepMoment;

// Writes a sweep as bytes. Only this process will read them.
class Writer {
  public:
    template <class T>
    void add(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        append(&value, sizeof(T));
    }
    template <class T>
    void add(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        add(std::uint64_t{values.size()});
        append(values.data(), values.size() * sizeof(T));
    }
    std::vector<char> bytes;

  private:
    void append(const void* from, std::size_t size) {
        if (size == 0) return;
        const auto* start = static_cast<const char*>(from);
        bytes.insert(bytes.end(), start, start + size);
    }
};

class Reader {
  public:
    explicit Reader(std::span<const char> bytes) : bytes_(bytes) {}
    template <class T>
    void take(T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        copy(&value, sizeof(T));
    }
    template <class T>
    void take(std::vector<T>& values) {
        std::uint64_t count = 0;
        take(count);
        if (count > bytes_.size() / sizeof(T)) {
            short_ = true;
            return;
        }
        values.resize(count);
        copy(values.data(), count * sizeof(T));
    }
    [[nodiscard]] bool is_whole() const { return !short_ && bytes_.empty(); }

  private:
    void copy(void* to, std::size_t size) {
        if (size > bytes_.size()) {
            short_ = true;
            return;
        }
        if (size > 0) std::memcpy(to, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
    }
    std::span<const char> bytes_;
    bool short_ = false;
};

template <class Archive, class Moment>
void visit_moment(Archive&& each, Moment& m) {
    each(m.moment), each(m.first_gate_m), each(m.gate_spacing_m), each(m.gate_stride);
    each(m.word_size_bits), each(m.scale), each(m.offset), each(m.control_flags);
    each(m.snr_threshold_db), each(m.folding_threshold_db);
    each(m.gate_counts), each(m.codes8), each(m.codes16);
}

template <class Archive, class S>
void visit_sweep(Archive&& each, S& sweep) {
    each(sweep.elevation_number), each(sweep.message_type), each(sweep.azimuth_spacing_deg);
    each(sweep.vcp_elevation_deg), each(sweep.radials);
}

std::vector<char> written(const Sweep& sweep) {
    Writer writer;
    std::size_t size = 256 + sweep.radials.size() * sizeof(level2::Radial);
    for (const SweepMoment& m : sweep.moments)
        size += 256 + 2 * m.gate_counts.size() + m.codes8.size() + 2 * m.codes16.size();
    writer.bytes.reserve(size);
    const auto add = [&](const auto& value) { writer.add(value); };
    visit_sweep(add, sweep);
    writer.add(std::uint64_t{sweep.moments.size()});
    for (const SweepMoment& moment : sweep.moments)
        visit_moment(add, moment);
    return std::move(writer.bytes);
}

Result<Sweep> sweep_of(std::span<const char> bytes) {
    Reader reader(bytes);
    Sweep sweep;
    const auto take = [&](auto& value) { reader.take(value); };
    visit_sweep(take, sweep);
    std::uint64_t moments = 0;
    reader.take(moments);
    for (; moments > 0; --moments) {
        visit_moment(take, sweep.moments.emplace_back());
        if (sweep.moments.size() > 1000) break;
    }
    if (!reader.is_whole()) return fail(ErrorCode::corrupt, "a shelved sweep is damaged");
    return sweep;
}

tl::unexpected<Error> system_failure(std::string_view what, int number) {
    auto failed = stormcellar::system_failure(fmt::format("{} of a growing volume", what), number);
    // Callers would read not_found as "the raw file is gone", so use io.
    if (failed.value().code == ErrorCode::not_found) failed.value().code = ErrorCode::io;
    return failed;
}

// Calls move(done) until all bytes are read or written. `done` is the number of bytes moved so far.
template <class Move>
Status move_all(std::uint64_t bytes, std::string_view verb, const Move& move) {
    for (std::uint64_t done = 0; done < bytes;) {
        const ssize_t moved = move(done);
        if (moved < 0 && errno == EINTR) continue;
        if (moved < 0) return system_failure(fmt::format("cannot {} shelved sweeps", verb), errno);
        if (moved == 0) return fail(ErrorCode::io, "shelved sweeps are gone");
        done += static_cast<std::uint64_t>(moved);
    }
    return {};
}

// Opens a file without a name. If the file system has no files without names, creates a file and
// removes its name at once.
int nameless_file(const std::filesystem::path& directory) {
    const int made = ::open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (made >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL)) return made;
    std::string name = (directory / (own_temporary_prefix() + "sweeps-XXXXXX")).native();
    const int named = ::mkostemp(name.data(), O_CLOEXEC);
    if (named >= 0) ::unlink(name.c_str());
    return named;
}

}  // namespace

Result<std::unique_ptr<SweepShelf>> SweepShelf::make_in(const std::filesystem::path& directory) {
    Descriptor descriptor{nameless_file(directory)};
    if (!descriptor.is_open())
        return system_failure("cannot make a file for the shelved sweeps", errno);
    return std::unique_ptr<SweepShelf>(new SweepShelf(std::move(descriptor)));
}

Result<SweepShelf::Place> SweepShelf::put(const Sweep& sweep) {
    const std::vector<char> bytes = written(sweep);
    if (bytes.size() > LZ4_MAX_INPUT_SIZE) {
        return fail(ErrorCode::unsupported, "a sweep of {} bytes", bytes.size());
    }
    const int size = static_cast<int>(bytes.size());
    std::vector<char> packed(static_cast<std::size_t>(LZ4_compressBound(size)));
    const int packed_size =
        LZ4_compress_default(bytes.data(), packed.data(), size, static_cast<int>(packed.size()));
    if (packed_size <= 0) return fail(ErrorCode::io, "a sweep cannot be packed");
    const Place place{end_, static_cast<std::uint64_t>(packed_size), bytes.size()};
    const auto moved = move_all(place.packed_bytes, "write", [&](std::uint64_t done) {
        return ::pwrite(descriptor_.number(), packed.data() + done, place.packed_bytes - done,
                        static_cast<off_t>(place.offset + done));
    });
    if (!moved) return pass_on(moved);
    end_ += place.packed_bytes;
    return place;
}

Result<Sweep> SweepShelf::get(const Place& place) const {
    std::vector<char> packed(place.packed_bytes);
    const auto moved = move_all(place.packed_bytes, "read", [&](std::uint64_t done) {
        return ::pread(descriptor_.number(), packed.data() + done, place.packed_bytes - done,
                       static_cast<off_t>(place.offset + done));
    });
    if (!moved) return pass_on(moved);
    std::vector<char> bytes(place.bytes);
    const int size =
        LZ4_decompress_safe(packed.data(), bytes.data(), static_cast<int>(packed.size()),
                            static_cast<int>(bytes.size()));
    if (size < 0 || static_cast<std::uint64_t>(size) != place.bytes) {
        return fail(ErrorCode::corrupt, "a shelved sweep is damaged");
    }
    return sweep_of(bytes);
}

}  // namespace stormcellar::pipeline
