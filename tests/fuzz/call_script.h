// tests/fuzz/call_script.h -- turns bytes into calls of the C interface: into arguments, good and
// bad, and into objects that earlier calls made.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "stormcellar.h"
#include "tests/fuzz/properties.h"

namespace stormcellar::fuzz {

template <class Object, void (*free_object)(Object*)>
struct FreeObject {
    void operator()(Object* object) const { free_object(object); }
};
template <class Object, void (*free_object)(Object*)>
using Pool = std::vector<std::unique_ptr<Object, FreeObject<Object, free_object>>>;

// The objects that calls have made.
struct Objects {
    Pool<stormcellar_volume, stormcellar_volume_free> volumes;
    Pool<stormcellar_grid, stormcellar_grid_free> grids;
    Pool<stormcellar_picture, stormcellar_picture_free> pictures;
    Pool<stormcellar_ladder, stormcellar_ladder_free> ladders;
    Pool<stormcellar_catalog, stormcellar_catalog_free> catalogs;
    Pool<stormcellar_file_list, stormcellar_file_list_free> files;
    Pool<stormcellar_cache, stormcellar_cache_free> caches;
    Pool<stormcellar_grid_list, stormcellar_grid_list_free> lists;
};

class Script {
  public:
    explicit Script(std::span<const std::byte> bytes) : bytes_(bytes) {}

    [[nodiscard]] bool has_ended() const { return bytes_.empty(); }
    [[nodiscard]] std::span<const std::byte> rest() const { return bytes_; }
    // Returns a number below `end`. Returns 0 after the end of the bytes.
    std::size_t below(std::size_t end) {
        if (bytes_.empty()) return 0;
        const auto byte = std::to_integer<std::size_t>(bytes_.front());
        bytes_ = bytes_.subspan(1);
        return byte % end;
    }
    template <class Value, std::size_t count>
    Value pick(const std::array<Value, count>& values) {
        return values[below(count)];
    }
    // Returns one of the good values, or seldom one of the bad values, so that most calls succeed.
    template <class Value, std::size_t good_count, std::size_t bad_count>
    Value pick(const std::array<Value, good_count>& good, const std::array<Value, bad_count>& bad) {
        return below(24) == 23 ? pick(bad) : pick(good);
    }
    // Returns a small number, or seldom a number that is too large for any array.
    std::int32_t number() {
        using Limits = std::numeric_limits<std::int32_t>;
        return pick(std::array{0, 0, 1}, std::array{3, -1, Limits::max(), Limits::min()});
    }
    // Returns one of the objects, or null.
    template <class Objects>
    auto* any(const Objects& pool) {
        const bool has_one = !pool.empty() && below(24) != 23;
        return has_one ? pool[below(pool.size())].get() : nullptr;
    }
    // Sets the size of a struct: mostly the right size, sometimes the size in an earlier version.
    template <class Struct>
    void set_size(Struct& one) {
        constexpr std::size_t whole = sizeof(Struct), pointer = sizeof(void*);
        one.size =
            pick(std::array<std::size_t, 1>{whole},
                 std::array<std::size_t, 4>{whole + 64, whole / 2 / pointer * pointer, pointer, 3});
    }

  private:
    std::span<const std::byte> bytes_;
};

// The error of a call. Sometimes the call gets no place for an error.
class CallError {
  public:
    explicit CallError(Script& script) : is_given_(script.below(8) != 7) {
        std::memset(&error_, 0x5A, sizeof error_);
    }
    [[nodiscard]] stormcellar_error* get() { return is_given_ ? &error_ : nullptr; }
    // Requires that the error has the code. Returns true if the call succeeded.
    bool check(stormcellar_code code) const {
        require(code != STORMCELLAR_INTERNAL, "a defect: {}", is_given_ ? error_.message : "");
        require(code >= STORMCELLAR_OK && code < STORMCELLAR_INTERNAL, "an unknown code");
        if (!is_given_) return code == STORMCELLAR_OK;
        require(error_.code == code, "the error has another code");
        const void* const end = std::memchr(error_.message, 0, sizeof error_.message);
        require(end != nullptr, "the message does not end");
        require((error_.message[0] == 0) == (code == STORMCELLAR_OK),
                "a message without a failure, or a failure without a message");
        return code == STORMCELLAR_OK;
    }

  private:
    bool is_given_;
    stormcellar_error error_;
};

// Keeps the object that a call made. Keeps at most five objects, so that memory stays small.
template <class Kept, class Object>
void keep(Kept& pool, Object* made, bool is_good, Script& script) {
    require((made != nullptr) == is_good, "an object without success, or success without one");
    if (made == nullptr) return;
    constexpr std::size_t most = 5;
    if (pool.size() == most)
        pool.erase(pool.begin() + static_cast<std::ptrdiff_t>(script.below(most)));
    pool.emplace_back(made);
}

// Calls a function that fills facts, and requires that it writes no byte beyond their size.
// Returns the facts if the call succeeded and filled all of them, else a struct of zeros.
template <class Facts, class Describe>
Facts described(Script& script, const Describe& describe) {
    constexpr unsigned char untouched = 0xA5;
    Facts facts;
    std::memset(static_cast<void*>(&facts), untouched, sizeof facts);
    script.set_size(facts);
    const std::size_t size = facts.size;
    CallError error(script);
    const bool is_good = error.check(describe(&facts, error.get()));
    require(facts.size == size, "the size of the facts changed");
    std::array<unsigned char, sizeof(Facts)> bytes;
    std::memcpy(bytes.data(), &facts, bytes.size());
    const std::size_t end = std::min(is_good ? size : sizeof size, sizeof facts);
    for (std::size_t i = std::max(end, sizeof size); i < bytes.size(); ++i)
        require(bytes[i] == untouched, "facts were written beyond their size");
    return is_good && size >= sizeof facts ? facts : Facts{};
}

}  // namespace stormcellar::fuzz
