// Checks the fuzzers' properties on their seeds and some thousand mutations of them, without
// libFuzzer.
#include <gtest/gtest.h>

#include "tests/fuzz/mutators.h"
#include "tests/fuzz/properties.h"
#include "tests/fuzz/seeds.h"

namespace stormcellar::fuzz {
namespace {

constexpr std::size_t most_bytes = 64'000;

// Changes one byte. This is the simplest mutator.
Bytes change_a_byte(Bytes bytes, std::size_t most, Random& random) {
    if (bytes.size() > most) bytes.resize(most);
    if (bytes.empty()) return Bytes{std::byte{1}};
    bytes[random() % bytes.size()] ^= static_cast<std::byte>(1U << (random() % 8));
    return bytes;
}

// Mutates bytes for properties that have no mutator of their own.
Bytes mutate_bytes(const Bytes& bytes, std::size_t most, Random&, const MutateBytes& mutate) {
    return mutate(bytes, most);
}

struct FuzzCase {
    const char* name;
    std::vector<Seed> (*seeds)();
    int changes = 0;
    void (*check)(std::span<const std::byte> bytes);
    Bytes (*mutate)(const Bytes& bytes, std::size_t most, Random& random,
                    const MutateBytes& mutate) = mutate_bytes;
};
class Fuzz : public ::testing::TestWithParam<FuzzCase> {};

// Checks each seed, and then more and more mutations of the seed.
TEST_P(Fuzz, PropertyHolds) {
    const FuzzCase& fuzzed = GetParam();
    for (const Seed& seed : fuzzed.seeds()) {
        ASSERT_NO_THROW(fuzzed.check(seed.bytes)) << seed.name;
        Random random(7);
        const MutateBytes byte = [&](Bytes bytes, std::size_t most) {
            return change_a_byte(std::move(bytes), most, random);
        };
        Bytes changed = seed.bytes;
        for (int i = 0; i < fuzzed.changes; ++i) {
            if (i % 10 == 0) changed = seed.bytes;
            changed = fuzzed.mutate(changed, most_bytes, random, byte);
            ASSERT_LE(changed.size(), most_bytes);
            ASSERT_NO_THROW(fuzzed.check(changed)) << seed.name << ", change " << i;
        }
    }
}

constexpr FuzzCase cases[] = {
    {"Container", container_seeds, 50, check_container, mutate_container},
    {"Live", live_seeds, 100, check_live, mutate_live},
    {"Messages", messages_seeds, 200, check_messages, mutate_messages},
    {"Compress", compress_seeds, 200, check_compress},
    {"Archive", archive_seeds, 200, check_archive},
    {"Bunzip", bunzip_seeds, 50, check_bunzip},
    {"GridFile", grid_file_seeds, 300, check_grid_file, mutate_grid_file},
    {"Request", request_seeds, 2000, check_request},
    {"Calls", call_seeds, 20, check_calls},
    {"Shapes", shape_seeds, 2000, check_shapes},
};
INSTANTIATE_TEST_SUITE_P(Each, Fuzz, ::testing::ValuesIn(cases),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace stormcellar::fuzz
