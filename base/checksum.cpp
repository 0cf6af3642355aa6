#include "base/checksum.h"

#include <algorithm>

#include <xxhash.h>
#include <zlib.h>

namespace stormcellar {

std::uint64_t xxh3_64(std::span<const std::byte> bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

struct Xxh3Stream::State {
    State() { XXH3_64bits_reset(state); }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { XXH3_freeState(state); }
    XXH3_state_t* state = XXH3_createState();
};

Xxh3Stream::Xxh3Stream() : state_(std::make_unique<State>()) {}
Xxh3Stream::Xxh3Stream(Xxh3Stream&&) noexcept = default;
Xxh3Stream& Xxh3Stream::operator=(Xxh3Stream&&) noexcept = default;
Xxh3Stream::~Xxh3Stream() = default;

void Xxh3Stream::append(std::span<const std::byte> bytes) {
    XXH3_64bits_update(state_->state, bytes.data(), bytes.size());
}

std::uint64_t Xxh3Stream::value() const {
    return XXH3_64bits_digest(state_->state);
}

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t previous) {
    // zlib returns its initial value for a null pointer, which an empty span may have.
    if (bytes.empty()) return previous;
    return static_cast<std::uint32_t>(
        ::crc32_z(previous, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace stormcellar
