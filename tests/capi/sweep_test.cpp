// Reads sweeps and moments of real volumes by the C interface, and compares every gate with that of
// the C++ library.
#include <atomic>
#include <cmath>
#include <cstring>
#include <thread>
#include <vector>

#include "stormcellar/level2/decode.h"
#include "tests/capi/opened.h"
#include "tests/testing/data.h"

namespace stormcellar::testing {
namespace {

// Compares a moment, and returns its number of gates.
std::size_t compare_moment(const OpenedVolume& volume, int32_t sweep, int32_t number,
                           const level2::SweepMoment& expected) {
    auto facts = empty_facts<stormcellar_moment_facts>();
    EXPECT_EQ(stormcellar_moment_describe(volume.get(), sweep, number, &facts, nullptr),
              STORMCELLAR_OK);
    EXPECT_EQ(facts.name, level2::moment_name(expected.moment));
    EXPECT_EQ(facts.unit, level2::moment_units(expected.moment));
    EXPECT_EQ(facts.gates, expected.gate_stride);
    EXPECT_EQ(facts.first_gate_m, expected.first_gate_m);
    EXPECT_EQ(facts.gate_spacing_m, expected.gate_spacing_m);
    EXPECT_EQ(facts.scale, expected.scale);
    EXPECT_EQ(facts.offset, expected.offset);
    EXPECT_EQ(facts.code_bytes, expected.word_size_bits / 8);
    const std::size_t radials = expected.gate_counts.size();
    const std::size_t count = radials * static_cast<std::size_t>(expected.gate_stride);
    std::vector<float> values(count);
    std::vector<std::uint8_t> states(count);
    EXPECT_EQ(stormcellar_moment_values(volume.get(), sweep, number, values.data(), count, nullptr),
              STORMCELLAR_OK);
    EXPECT_EQ(stormcellar_moment_states(volume.get(), sweep, number, states.data(), count, nullptr),
              STORMCELLAR_OK);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t radial = i / static_cast<std::size_t>(expected.gate_stride);
        const auto gate =
            static_cast<std::int32_t>(i % static_cast<std::size_t>(expected.gate_stride));
        const level2::GateStatus status = expected.status(radial, gate);
        if (states[i] != static_cast<std::uint8_t>(status)) ++wrong;
        const bool is_value = status == level2::GateStatus::valid;
        if (std::isnan(values[i]) == is_value ||
            (is_value && values[i] != expected.value_of(expected.code(radial, gate))))
            ++wrong;
    }
    EXPECT_EQ(wrong, 0U);
    return count;
}

TEST(CSweep, EveryGateIsThatOfTheLibrary) {
    STORMCELLAR_NEED_DATA();
    for (const char* name : {"volumes/KTLX19990503_235621.gz", "volumes/KLBB20160601_150025_V06"}) {
        const OpenedVolume volume = opened(real_file(name));
        const auto decoded = level2::decode_file(real_file(name));
        ASSERT_TRUE(decoded);
        std::size_t gates = 0;
        for (std::size_t i = 0; i < decoded->volume.sweeps.size(); ++i) {
            const level2::Sweep& sweep = decoded->volume.sweeps[i];
            auto facts = empty_facts<stormcellar_sweep_facts>();
            ASSERT_EQ(
                stormcellar_sweep_describe(volume.get(), static_cast<int32_t>(i), &facts, nullptr),
                STORMCELLAR_OK);
            EXPECT_EQ(facts.elevation_number, sweep.elevation_number);
            EXPECT_EQ(facts.elevation_deg, sweep.mean_elevation_deg());
            ASSERT_EQ(static_cast<std::size_t>(facts.radials), sweep.radials.size());
            ASSERT_EQ(static_cast<std::size_t>(facts.moments), sweep.moments.size());
            EXPECT_LE(facts.start_ms, facts.end_ms);
            std::vector<stormcellar_radial> radials(sweep.radials.size());
            ASSERT_EQ(stormcellar_sweep_radials(volume.get(), static_cast<int32_t>(i),
                                                radials.data(), radials.size(), nullptr),
                      STORMCELLAR_OK);
            for (std::size_t k = 0; k < radials.size(); ++k) {
                ASSERT_EQ(radials[k].azimuth_deg, sweep.radials[k].azimuth_deg);
                ASSERT_EQ(radials[k].time_ms, sweep.radials[k].time.time_since_epoch().count());
            }
            for (std::size_t k = 0; k < sweep.moments.size(); ++k)
                gates += compare_moment(volume, static_cast<int32_t>(i), static_cast<int32_t>(k),
                                        sweep.moments[k]);
        }
        EXPECT_GT(gates, 1'000'000U) << name;
    }
}

TEST(CSweep, ManyThreadsReadOneVolume) {
    STORMCELLAR_NEED_DATA();
    const OpenedVolume volume = opened(real_file("volumes/KTLX19990503_235621.gz"));
    const int32_t sweeps = facts_of(volume).sweeps;
    std::atomic<int> failures{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            for (int32_t sweep = 0; sweep < sweeps; ++sweep) {
                stormcellar_error error{};
                auto facts = empty_facts<stormcellar_moment_facts>();
                auto of_sweep = empty_facts<stormcellar_sweep_facts>();
                if (stormcellar_sweep_describe(volume.get(), sweep, &of_sweep, &error) != 0 ||
                    stormcellar_moment_describe(volume.get(), sweep, 0, &facts, &error) != 0) {
                    ++failures;
                    continue;
                }
                std::vector<float> values(static_cast<std::size_t>(of_sweep.radials) *
                                          static_cast<std::size_t>(facts.gates));
                if (stormcellar_moment_values(volume.get(), sweep, 0, values.data(), values.size(),
                                              &error) != 0)
                    ++failures;
                if (stormcellar_sweep_describe(volume.get(), sweeps, &of_sweep, &error) !=
                    STORMCELLAR_BAD_ARGUMENT)
                    ++failures;
            }
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(failures, 0);
}

TEST(CSweep, NumbersAndRoomAreChecked) {
    STORMCELLAR_NEED_DATA();
    const OpenedVolume volume = opened(real_file("volumes/KTLX19990503_235621.gz"));
    stormcellar_error error{};
    auto sweep = empty_facts<stormcellar_sweep_facts>();
    auto moment = empty_facts<stormcellar_moment_facts>();
    const int32_t sweeps = facts_of(volume).sweeps;
    for (const int32_t number : {-1, sweeps, INT32_MAX, INT32_MIN}) {
        EXPECT_EQ(stormcellar_sweep_describe(volume.get(), number, &sweep, &error),
                  STORMCELLAR_BAD_ARGUMENT);
        EXPECT_EQ(stormcellar_moment_describe(volume.get(), number, 0, &moment, &error),
                  STORMCELLAR_BAD_ARGUMENT);
        EXPECT_EQ(stormcellar_moment_describe(volume.get(), 0, number, &moment, &error),
                  STORMCELLAR_BAD_ARGUMENT);
    }
    float value = 7;
    EXPECT_EQ(stormcellar_moment_values(volume.get(), 0, 0, &value, 1, &error),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(value, 7);
    EXPECT_NE(std::string(error.message).find("count is 1; there are "), std::string::npos);
    stormcellar_radial radial{};
    EXPECT_EQ(stormcellar_sweep_radials(volume.get(), 0, &radial, 1, &error),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_moment_find(volume.get(), 0, nullptr, nullptr, &error),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_moment_codes(volume.get(), 0, 0, nullptr, &error),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_sweep_describe(nullptr, 0, &sweep, &error), STORMCELLAR_BAD_ARGUMENT);
}

}  // namespace
}  // namespace stormcellar::testing
