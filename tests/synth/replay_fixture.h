// tests/synth/replay_fixture.h -- a directory of small volumes, and a drop directory to replay them
// to.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "level2/containers/archive_header.h"
#include "synth/replay.h"
#include "tests/level2/wire.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::synth {

namespace fs = std::filesystem;
namespace wire = level2::wire;

inline constexpr std::size_t header_date_at = 12;  // ICD 2620010: the day, then the milliseconds
inline constexpr std::size_t header_icao_at = 20;

inline wire::Bytes volume_at(std::uint32_t ms, unsigned sweeps = 1) {
    wire::Bytes bytes = wire::ldm_volume(sweeps, 4);
    wire::overwrite_u32(bytes, header_date_at + 4, ms);
    return bytes;
}

// Returns a small volume of a station. The name of the station has four letters.
inline wire::Bytes volume_of(std::string_view station, std::uint32_t ms, unsigned sweeps = 1) {
    wire::Bytes bytes = volume_at(ms, sweeps);
    for (std::size_t i = 0; i < station.size(); ++i)
        bytes[header_icao_at + i] = static_cast<std::byte>(station[i]);
    return bytes;
}

// Returns the time of volume_at(second) as in names of chunks: "20220317-000002".
inline std::string day_and_second(std::size_t second) {
    const auto header = level2::read_archive_header(wire::archive_header());
    const UtcTime time =
        time_from_nexrad(header.value().date, static_cast<std::uint32_t>(1000 * second));
    std::string text = format_compact(time);
    text[8] = '-';
    return text;
}

// Returns the same member of each row.
template <class Row, class Part>
std::vector<Part> parts_of(const std::vector<Row>& rows, Part Row::*part) {
    std::vector<Part> parts;
    for (const Row& row : rows)
        parts.push_back(row.*part);
    return parts;
}

class Replay : public ::testing::Test {
  protected:
    void SetUp() override {
        fs::create_directory(directory_ / "in");
        fs::create_directory(drop());
    }
    void put(const std::string& name, const wire::Bytes& bytes) const {
        fs::create_directories((directory_ / "in" / name).parent_path());
        ASSERT_TRUE(write_file_atomically(real_file_system(), directory_ / "in" / name, bytes));
    }
    [[nodiscard]] fs::path drop() const { return directory_ / "drop"; }
    [[nodiscard]] std::vector<ReplayItem> items() const {
        auto found = find_replay_items({directory_ / "in"});
        EXPECT_TRUE(found) << found.error().message;
        return found ? *found : std::vector<ReplayItem>{};
    }
    [[nodiscard]] Result<ReplayReport> play(const ReplayOptions& options) const {
        return replay(items(), drop(), real_file_system(), options);
    }
    static ReplayOptions at_once(Delivery delivery) {
        ReplayOptions options;
        options.delivery = delivery;
        options.interval_s = 0;
        return options;
    }
    testing::TemporaryDirectory directory_;
};

}  // namespace stormcellar::synth
