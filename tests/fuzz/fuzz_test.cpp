// Checks the fuzzers' properties on their seeds and some thousand mutations of them, without
// libFuzzer.
#include <gtest/gtest.h>

#include "tests/fuzz/mutators.h"
#include "tests/fuzz/properties.h"
#include "tests/fuzz/seeds.h"

namespace stormcellar::fuzz {
namespace {

constexpr std::size_t most_bytes = 64'000;

// Changes one byte: the simplest mutator.
Bytes change_a_byte(Bytes bytes, std::size_t most, Random& random) {
    if (bytes.size() > most) bytes.resize(most);
    if (bytes.empty()) return Bytes{std::byte{1}};
    bytes[random() % bytes.size()] ^= static_cast<std::byte>(1U << (random() % 8));
    return bytes;
}

// For properties without a mutator of their own.
Bytes mutate_bytes(const Bytes& bytes, std::size_t most, Random&, const MutateBytes& mutate) {
    return mutate(bytes, most);
}

// Checks each seed, and then mutates it more and more.
template <class Check, class Mutate>
void check_seeds(const std::vector<Seed>& seeds, int changes, Check check, Mutate mutate) {
    for (const Seed& seed : seeds) {
        ASSERT_NO_THROW(check(seed.bytes)) << seed.name;
        Random random(7);
        const MutateBytes byte = [&](Bytes bytes, std::size_t most) {
            return change_a_byte(std::move(bytes), most, random);
        };
        Bytes changed = seed.bytes;
        for (int i = 0; i < changes; ++i) {
            if (i % 10 == 0) changed = seed.bytes;
            changed = mutate(changed, most_bytes, random, byte);
            ASSERT_LE(changed.size(), most_bytes);
            ASSERT_NO_THROW(check(changed)) << seed.name << ", change " << i;
        }
    }
}

TEST(Fuzz, Container) {
    check_seeds(container_seeds(), 50, check_container, mutate_container);
}

TEST(Fuzz, Live) {
    check_seeds(live_seeds(), 100, check_live, mutate_live);
}

TEST(Fuzz, Messages) {
    check_seeds(messages_seeds(), 200, check_messages, mutate_messages);
}

TEST(Fuzz, Compress) {
    check_seeds(compress_seeds(), 200, check_compress, mutate_bytes);
}

TEST(Fuzz, Archive) {
    check_seeds(archive_seeds(), 200, check_archive, mutate_bytes);
}

TEST(Fuzz, Bunzip) {
    check_seeds(bunzip_seeds(), 50, check_bunzip, mutate_bytes);
}

TEST(Fuzz, GridFile) {
    check_seeds(grid_file_seeds(), 300, check_grid_file, mutate_grid_file);
}

TEST(Fuzz, Request) {
    check_seeds(request_seeds(), 2000, check_request, mutate_bytes);
}

}  // namespace
}  // namespace stormcellar::fuzz
