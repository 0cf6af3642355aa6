// Compares every real volume, field by field, with what an independent decoder found in it
// (data/golden).
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/checksum.h"
#include "level2/containers/gzip_stream.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/describe.h"
#include "tests/level2/joined_files.h"
#include "tests/testing/data.h"
#include "tests/testing/test_name.h"

namespace stormcellar::level2 {
namespace {

using Json = nlohmann::ordered_json;

constexpr double angle_tolerance_deg = 1e-3;
constexpr double velocity_tolerance_mps = 1e-2;
constexpr double mean_tolerance = 1e-6;  // relative

std::vector<std::string> golden_names() {
    const auto data = testing::data_directory();
    std::vector<std::string> names;
    if (!data) return {"no_real_volumes"};
    for (const auto& entry : std::filesystem::directory_iterator(*data / "golden"))
        names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

// Returns the chunks of a set, joined in the order of their names, or the file itself.
std::vector<std::byte> bytes_of(const std::filesystem::path& data, const std::string& name) {
    if (!name.starts_with("CHUNKS_")) {
        for (const char* folder : {"volumes", "sequence-kbgm", "mosaic-northeast"}) {
            const auto path = data / folder / name;
            if (std::filesystem::exists(path)) return read_file(path).value();
        }
        ADD_FAILURE() << "the data have no file of this name";
        return {};
    }
    for (const auto& set : std::filesystem::directory_iterator(data / "chunks")) {
        if (name.starts_with("CHUNKS_" + set.path().filename().string() + "_"))
            return joined_files(set.path());
    }
    ADD_FAILURE() << "the data have no chunk set of this name";
    return {};
}

double tolerance_of(const std::string& key, double expected) {
    if (key == "mean") return mean_tolerance * std::abs(expected);
    if (key == "nyquist_velocity" || key == "nyquist_values") return velocity_tolerance_mps;
    static const std::set<std::string> angles = {
        "mean_elevation", "min_elevation", "max_elevation", "first_azimuth",    "last_azimuth",
        "vcp_elevation",  "angle",         "lat",           "max_azimuth_step", "lon"};
    if (angles.contains(key)) return angle_tolerance_deg;
    if (key == "min" || key == "max") return 1e-9 * std::max(1.0, std::abs(expected));
    return 0;
}

bool is_time(const std::string& key) {
    return key == "time" || key.ends_with("_time");
}

void expect_same(const Json& expected, const Json& found, const std::string& key,
                 const std::string& where) {
    if (expected.is_object()) {
        for (const auto& [name, value] : expected.items()) {
            if (name == "confirmed_by") continue;
            ASSERT_TRUE(found.contains(name)) << where << " lacks " << name;
            expect_same(value, found.at(name), name, where + "." + name);
        }
    } else if (expected.is_array()) {
        ASSERT_EQ(expected.size(), found.size()) << where;
        for (std::size_t i = 0; i < expected.size(); ++i)
            expect_same(expected[i], found[i], key, where + "[" + std::to_string(i) + "]");
    } else if (expected.is_number() && found.is_number()) {
        const double value = expected.get<double>();
        EXPECT_NEAR(found.get<double>(), value, tolerance_of(key, value)) << where;
    } else if (is_time(key) && expected.is_string() && found.is_string()) {
        EXPECT_EQ(found, expected) << where;
    } else {
        EXPECT_EQ(found, expected) << where;
    }
}

// Returns the fields for which the decoder describes the whole of a damaged file, but the reference
// only the part before the damage.
const std::set<std::string>& prefix_only_fields() {
    static const std::set<std::string> fields = {"message_counts",
                                                 "vcp",
                                                 "vcp_source",
                                                 "vcp_message",
                                                 "volume_block",
                                                 "n_sweeps",
                                                 "n_radials",
                                                 "msg31_compression",
                                                 "radial_status_counts",
                                                 "first_radial_time",
                                                 "last_radial_time",
                                                 "site_msg31"};
    return fields;
}

// Returns false for remarks in the reference, and for fields that the reference takes from the name
// of the file. For a damaged file, also returns false for prefix_only_fields().
bool is_compared(const std::string& field, const Json& golden) {
    static const std::set<std::string> remarks = {
        "sha256", "oddities", "n_oddities", "agreement", "sources", "corruption", "sweeps", "site"};
    if (remarks.contains(field)) return false;
    return golden.at("corruption").is_null() || !prefix_only_fields().contains(field);
}

// In this file, the reference takes a radial that has lost 1,688 bytes for intact; see the test
// below.
constexpr std::string_view half_radial_file = "KLVX20050106_163401.gz";
constexpr std::size_t half_radial_sweep = 4;

// KMPX20060106_184002 has lost bytes inside its metadata, at offset 172672, so later messages begin
// at unexpected places. The reference takes 62 frames for fill frames and notices the damage later.
std::uint64_t corruption_offset(const Json& golden) {
    if (golden.at("file") == "KMPX20060106_184002.gz") return 172672;
    return golden.at("corruption").at("offset").get<std::uint64_t>();
}

class GoldenTest : public ::testing::TestWithParam<std::string> {};

TEST_P(GoldenTest, EveryFieldIsTheSame) {
    STORMCELLAR_NEED_DATA();
    const auto data = *testing::data_directory();
    const Json golden = Json::parse(std::ifstream(data / "golden" / (GetParam() + ".json")));
    const auto bytes = bytes_of(data, GetParam());
    DecodeOptions options;
    options.threads = 2;
    options.fallback_station = GetParam().substr(0, 4);
    Result<Decoded> decoded = decode(bytes, options);
    ASSERT_TRUE(decoded) << decoded.error().message;
    const Json found = describe(*decoded, {golden.at("file"), bytes.size()});

    for (const auto& [field, value] : golden.items()) {
        if (!is_compared(field, golden)) continue;
        ASSERT_TRUE(found.contains(field)) << field;
        expect_same(value, found.at(field), field, field);
    }
    // The header of an ARCHIVE2 file does not name the site; the file name does.
    const Json site =
        golden.at("site").is_null() ? Json(options.fallback_station) : golden.at("site");
    EXPECT_EQ(found.at("site"), site);

    std::vector<Sweep>& sweeps = decoded->volume.sweeps;
    const Json& corruption = golden.at("corruption");
    if (!corruption.is_null()) {
        ASSERT_TRUE(decoded->report.corruption);
        EXPECT_EQ(decoded->report.corruption->offset, corruption_offset(golden));
        EXPECT_GT(decoded->report.bytes_dropped, 0);
        EXPECT_FALSE(decoded->report.complete);
    } else {
        EXPECT_FALSE(decoded->report.corruption) << decoded->report.corruption->reason;
        EXPECT_EQ(decoded->report.bytes_dropped, 0);
    }
    ASSERT_GE(sweeps.size(), golden.at("sweeps").size());
    for (std::size_t i = 0; i < golden.at("sweeps").size(); ++i) {
        const Json& expected = golden.at("sweeps")[i];
        if (GetParam() == half_radial_file && i == half_radial_sweep) continue;
        const auto radials = expected.at("n_radials").get<std::size_t>();
        ASSERT_GE(sweeps[i].radials.size(), radials) << "sweep " << i;
        // A sweep may continue after the damage, but the reference has only the radials before it.
        if (!corruption.is_null()) sweeps[i].radials.resize(radials);
        expect_same(expected, describe_sweep(sweeps[i], i), "", "sweep " + std::to_string(i));
    }
}

// In KLVX20050106_163401, only 744 bytes of radial 102 of sweep 4 are at offset 3964160 of the
// message stream; radial 201 follows. The reference took 2432 bytes from there as radial 102. The
// decoder drops the half radial. If the half radial is added, the checksums equal the checksums in
// the reference.
TEST(GoldenHalfRadial, IsDroppedAndWouldGiveTheReferencesChecksum) {
    STORMCELLAR_NEED_DATA();
    const auto data = *testing::data_directory();
    const std::string name{half_radial_file};
    const Json golden = Json::parse(std::ifstream(data / "golden" / (name + ".json")));
    const Json& expected = golden.at("sweeps")[half_radial_sweep];
    auto decoded = decode(bytes_of(data, name)).value();
    Sweep& sweep = decoded.volume.sweeps.at(half_radial_sweep);
    ASSERT_GT(sweep.radials.size(), 101);
    EXPECT_EQ(sweep.radials[100].azimuth_number, 101);
    EXPECT_EQ(sweep.radials[101].azimuth_number, 201);
    EXPECT_EQ(decoded.report.problems.front().offset, 3964160);

    sweep.radials.resize(expected.at("n_radials").get<std::size_t>() - 1);
    const Json found = describe_sweep(sweep, half_radial_sweep);
    const auto bytes = bytes_of(data, name);
    GzipStream gzip{bytes};
    std::vector<std::byte> stream;
    for (auto piece = gzip.next(); !piece.empty(); piece = gzip.next())
        stream.insert(stream.end(), piece.begin(), piece.end());
    struct Part {
        const char* moment;
        std::size_t pointer, gates;
    };
    for (const Part& part : {Part{"REF", 100, 336}, {"VEL", 436, 920}, {"SW", 1356, 920}}) {
        const auto crc_text = found.at("moments").at(part.moment).at("crc32").get<std::string>();
        const auto crc = static_cast<std::uint32_t>(std::stoul(crc_text, nullptr, 16));
        const std::size_t at = 24 + 3964160 + 28 + part.pointer;
        const auto with_half = crc32(std::span{stream}.subspan(at, part.gates), crc);
        EXPECT_EQ(Json(fmt::format("{:08x}", with_half)),
                  expected.at("moments").at(part.moment).at("crc32"))
            << part.moment;
    }
}

INSTANTIATE_TEST_SUITE_P(All, GoldenTest, ::testing::ValuesIn(golden_names()),
                         [](const auto& test) { return testing::test_name(test.param); });

}  // namespace
}  // namespace stormcellar::level2
