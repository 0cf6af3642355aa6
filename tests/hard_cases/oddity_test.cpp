// Tests that an odd value in a field of a radial does not lose a gate if the structure of the
// message stays intact. The test takes each field of the message header, of the headers of messages
// 1 and 31, and of the blocks. It sets the field to values that no radar sends, in one radial and
// in all. Every gate of the real volume must still be there.
//
// Fields that give the place of gates, or the sweep and azimuth to which they belong, may lose
// gates. Then everything returned must be in the volume, and everything lost must be reported.
// The test takes the first 150,000 bytes of messages of each volume, or the first 8 MiB if
// STORMCELLAR_MUTANTS is set, and its last ten messages.
#include <cstdlib>
#include <map>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"
#include "tests/hard_cases/message_fields.h"
#include "tests/hard_cases/unpacked_volume.h"
#include "tests/testing/data.h"
#include "tests/testing/test_name.h"

namespace stormcellar::level2 {
namespace {

using wire::Bytes;

std::vector<std::uint32_t> odd_values(std::size_t width) {
    if (width == 1) return {0, 1, 2, 3, 77, 127, 128, 255};
    if (width == 2) return {0, 1, 2, 77, 7304, 40'001, 0x7FFF, 0x8000, 0xFFFF};
    // The values include NaN, infinity, 1e30, text in lower case, text without letters, and a time
    // after midnight.
    return {0,          1,          0x7FFFFFFF, 0xFFFFFFFF, 0x7FC00000,
            0x7F800000, 0x7149F2CA, 0x6B746C78, 0x2A2A2A2A, 90'000'000};
}

// Returns the place where the block of this name begins in a message 31, or none if the message has
// no such block.
std::optional<std::size_t> block_at(std::span<const std::byte> message, std::string_view name) {
    const std::uint32_t blocks = number_at(message, 58, 2);
    for (std::uint32_t i = 0; i < blocks; ++i) {
        const std::size_t at = 28 + number_at(message, 60 + 4 * i, 4);
        const auto* text = reinterpret_cast<const char*>(message.data()) + at;
        if (at > 28 && std::string_view{text, 4} == name) return at;
    }
    return std::nullopt;
}

// Sets the field to the value. Returns false if the radial lacks the block of the field, or has the
// value already.
bool set_field(std::span<std::byte> message, const MessageField& field, std::uint32_t value) {
    std::size_t at = field.at;
    if (!field.block.empty()) {
        const auto block = block_at(message, field.block);
        if (!block) return false;
        at += *block;
    }
    if (number_at(message, at, field.width) == value) return false;
    set_number(message, at, field.width, value);
    return true;
}

// The gates of a radial by the names of their moments.
using Gates = std::map<Moment, std::vector<std::uint16_t>>;

std::vector<Gates> gates_of(const Volume& volume) {
    std::vector<Gates> all;
    for (const Sweep& sweep : volume.sweeps) {
        for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
            Gates& gates = all.emplace_back();
            for (const SweepMoment& moment : sweep.moments) {
                const int count = moment.gate_counts[radial];
                for (int gate = 0; gate < count; ++gate)
                    gates[moment.moment].push_back(moment.code(radial, gate));
            }
        }
    }
    return all;
}

// Returns true if all gates in `found` are gates of the radial. Moments, or the last gates of
// moments, may be missing.
bool is_part_of(const Gates& found, const Gates& own) {
    return std::all_of(found.begin(), found.end(), [&](const auto& named) {
        const auto whole = own.find(named.first);
        const auto& gates = named.second;
        return whole != own.end() && gates.size() <= whole->second.size() &&
               std::equal(gates.begin(), gates.end(), whole->second.begin());
    });
}

// Matches the returned radials with the radials of the volume, both in the order of the file, and
// finds the first one without a match. Returns a text about it, or an empty text if there is none.
std::string invented(const std::vector<Gates>& found, const std::vector<Gates>& own) {
    std::size_t at = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        while (at < own.size() && !is_part_of(found[i], own[at]))
            ++at;
        if (at++ == own.size()) return fmt::format("radial {} is none of the volume's", i);
    }
    return {};
}

std::string said_twice(const DecodeReport& report) {
    std::set<std::pair<std::string, std::string>> said;
    for (const Problem& problem : report.problems) {
        if (!said.emplace(problem.code, problem.message).second) return problem.text();
    }
    return {};
}

class OddityTest : public ::testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        const auto bytes = read_file(*testing::data_directory() / "volumes" / GetParam());
        ASSERT_TRUE(bytes) << bytes.error().message;
        const bool long_form = std::getenv("STORMCELLAR_MUTANTS") != nullptr;
        volume_ = short_stream(unpack(*bytes), long_form ? std::size_t{8} << 20 : 150'000);
        const auto decoded = decode(volume_.plain_file());
        ASSERT_TRUE(decoded) << decoded.error().message;
        own_ = gates_of(decoded->volume);
        ASSERT_EQ(own_.size(), volume_.radials);
        own_problems_ = decoded->report.problems.size();
    }

    // Sets the field in radial `number`, or in all radials. Returns false if no radial changes.
    bool set(UnpackedVolume& odd, const MessageField& field, std::uint32_t value,
             std::optional<std::size_t> number) const {
        bool any = false;
        for (const StreamMessage& message : odd.messages) {
            if (!message.radial || (number && *message.radial != *number)) continue;
            const auto bytes = std::span{odd.stream}.subspan(message.offset, message.length);
            any = set_field(bytes, field, value) || any;
        }
        return any;
    }

    void check(const MessageField& field, std::uint32_t value, std::optional<std::size_t> number) {
        UnpackedVolume odd = volume_;
        if (!set(odd, field, value, number)) return;
        ++tried_;
        const std::string what =
            fmt::format("{} {} {:#x} in {}", field.block, field.name, value,
                        number ? fmt::format("radial {}", *number) : std::string{"all radials"});
        const auto decoded = decode(odd.plain_file());
        if (!field.places_gates) {
            ASSERT_TRUE(decoded) << what << ": " << decoded.error().message;
            EXPECT_TRUE(gates_of(decoded->volume) == own_) << what << ": gates are lost";
            EXPECT_EQ(decoded->report.bytes_dropped, 0U) << what;
        } else if (decoded) {
            const std::vector<Gates> found = gates_of(decoded->volume);
            EXPECT_EQ(invented(found, own_), "") << what;
            if (found != own_) {
                EXPECT_FALSE(decoded->report.problems.empty()) << what;
            }
        }
        if (!decoded) return;
        if (!field.places_gates) {
            EXPECT_EQ(said_twice(decoded->report), "") << what;
        }
        const std::size_t most = field.places_gates ? DecodeReport::max_problems : 8;
        EXPECT_LE(decoded->report.problems.size(), own_problems_ + most) << what;
    }

    void check(std::span<const MessageField> fields) {
        for (const MessageField& field : fields) {
            for (const std::uint32_t value : odd_values(field.width)) {
                check(field, value, std::nullopt);
                for (const std::size_t number : {std::size_t{0}, own_.size() / 2, own_.size() - 1})
                    check(field, value, number);
            }
        }
    }

    UnpackedVolume volume_;
    std::vector<Gates> own_;
    std::size_t own_problems_ = 0;
    std::size_t tried_ = 0;
};

TEST_P(OddityTest, CostsNoGate) {
    const auto first = std::find_if(volume_.messages.begin(), volume_.messages.end(),
                                    [](const StreamMessage& m) { return m.radial.has_value(); });
    check(header_fields);
    if (first->type == 31) {
        check(fields_of_31);
        check(block_fields_of_31);
        check(moment_fields_of_31);
    } else {
        check(fields_of_1);
    }
    EXPECT_GT(tried_, 500U);
}

INSTANTIATE_TEST_SUITE_P(Volumes, OddityTest,
                         ::testing::Values("KLBB20160601_150025_V06", "KLOT20220317_000842_V06",
                                           "Level2_TSTL_20220213_2357.ar2v",
                                           "KTLX19990503_235621.gz", "KBBX20060113_170337.gz"),
                         [](const auto& each) { return testing::test_name(each.param); });

}  // namespace
}  // namespace stormcellar::level2
