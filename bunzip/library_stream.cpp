#include "bunzip/library_stream.h"

#include <algorithm>
#include <limits>
#include <new>

#include <bzlib.h>

namespace stormcellar::bunzip {
namespace {

constexpr std::size_t largest_step = std::numeric_limits<unsigned>::max();

}  // namespace

struct LibraryStream::State {
    bz_stream bz{};
    std::size_t fed = 0;
};

LibraryStream::LibraryStream(std::span<const std::byte> stream)
    : stream_(stream), state_(std::make_unique<State>()) {
    bz_stream& bz = state_->bz;
    if (BZ2_bzDecompressInit(&bz, 0, 0) != BZ_OK) throw std::bad_alloc{};
    // libbz2 does not write through next_in; its C interface merely lacks the const.
    bz.next_in = const_cast<char*>(reinterpret_cast<const char*>(stream.data()));
}

LibraryStream::~LibraryStream() {
    BZ2_bzDecompressEnd(&state_->bz);
}

std::size_t LibraryStream::input_bytes() const {
    return state_->fed - state_->bz.avail_in;
}

std::size_t LibraryStream::read(std::span<std::byte> out) {
    bz_stream& bz = state_->bz;
    std::size_t made = 0;
    while (!ended_ && made < out.size()) {
        if (bz.avail_in == 0 && state_->fed < stream_.size()) {
            bz.avail_in =
                static_cast<unsigned>(std::min(stream_.size() - state_->fed, largest_step));
            state_->fed += bz.avail_in;
        }
        bz.next_out = reinterpret_cast<char*>(out.data() + made);
        bz.avail_out = static_cast<unsigned>(std::min(out.size() - made, largest_step));
        const unsigned room = bz.avail_out;
        const int code = BZ2_bzDecompress(&bz);
        made += room - bz.avail_out;
        const bool starved = bz.avail_in == 0 && state_->fed == stream_.size() && bz.avail_out != 0;
        if (code == BZ_MEM_ERROR) throw std::bad_alloc{};
        if (code == BZ_OK && !starved) continue;
        ended_ = true;
        if (code == BZ_OK) {
            status_ = Status::truncated;
        } else if (code != BZ_STREAM_END) {
            status_ = Status::corrupt;
        }
    }
    return made;
}

}  // namespace stormcellar::bunzip
