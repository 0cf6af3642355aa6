// Tests a station's volumes over time as a Zarr tree. tests/python/test_served_archive.py reads
// the tree with xarray and compares it with open_archive().
#include "web/doors/zarr/station_door.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <zstd.h>

#include "stormcellar/level2/decode.h"
#include "tests/web/served.h"
#include "tests/web/served_volumes.h"

namespace stormcellar::web {
namespace {

using level2::GateStatus;
using std::chrono::milliseconds;

template <class Number>
std::vector<Number> unpacked(const Answer& answer) {
    EXPECT_EQ(answer.status, 200U);
    const std::string packed = body_of(answer);
    std::vector<Number> numbers(std::size_t{4} << 20);
    const std::size_t size = ::ZSTD_decompress(numbers.data(), numbers.size() * sizeof(Number),
                                               packed.data(), packed.size());
    EXPECT_EQ(::ZSTD_isError(size), 0U);
    numbers.resize(::ZSTD_isError(size) != 0 ? 0 : size / sizeof(Number));
    return numbers;
}

nlohmann::json document_in(const Answer& answer) {
    EXPECT_EQ(answer.status, 200U);
    return nlohmann::json::parse(body_of(answer));
}

// Names of the volumes of the sequence, in the order of time.
std::vector<std::string> sequence_names() {
    std::vector<std::string> names;
    for (const auto& file :
         std::filesystem::directory_iterator(*testing::data_directory() / "sequence-kbgm"))
        names.push_back(file.path().filename().string());
    std::ranges::sort(names);
    return names;
}

class StationDoorTest : public ::testing::Test {
  protected:
    void SetUp() override { STORMCELLAR_NEED_DATA(); }

    void take(const std::string& file, const std::string& name) {
        served_.take(*testing::data_directory() / file, name);
    }
    void take_sequence(std::size_t first, std::size_t count) {
        const auto names = sequence_names();
        for (std::size_t i = first; i < first + count; ++i)
            take("sequence-kbgm/" + names.at(i), names.at(i));
    }
    [[nodiscard]] std::unique_ptr<StationDoor> made_door() {
        auto trees = std::make_shared<StationTrees>(
            StationTreesOptions{.catalog = served_.state() / "catalog",
                                .numbers = std::make_shared<TimeNumbers>(numbers_.path()),
                                .look_every = milliseconds{0}});
        return std::make_unique<StationDoor>(std::move(trees),
                                             std::make_shared<KeptAnswers>(std::uint64_t{64} << 20),
                                             std::make_shared<FunctionDoor>([](const Request&) {
                                                 return sentence(200, "a domain of this name");
                                             }));
    }
    StationDoor& door() {
        if (!door_) door_ = made_door();
        return *door_;
    }
    Answer get(const std::string& key, Fields headers = {}) {
        return asked(door(), "/zarr3/volumes/" + key, std::move(headers));
    }

    ServedVolumes served_{false};
    testing::TemporaryDirectory numbers_;
    std::unique_ptr<StationDoor> door_;
};

TEST_F(StationDoorTest, TheDocumentsAgreeWithEachOther) {
    take_sequence(0, 2);
    const auto root = document_in(get("KBGM/zarr.json"));
    EXPECT_EQ(root.at("attributes").at("instrument_name"), "KBGM");
    const auto& all = root.at("consolidated_metadata").at("metadata");
    ASSERT_TRUE(all.contains("VCP-21"));
    ASSERT_TRUE(all.contains("VCP-21/sweep_10/VRADH_status"));
    ASSERT_FALSE(all.contains("VCP-21/sweep_11"));
    for (const auto& [path, node] : all.items()) {
        const auto own = document_in(get("KBGM/" + path + "/zarr.json"));
        EXPECT_EQ(own.at("node_type"), node.at("node_type"));
        EXPECT_EQ(own.at("attributes"), node.at("attributes"));
        if (node.at("node_type") == "array") {
            EXPECT_EQ(own, node) << path;
        }
    }
    const auto& values = all.at("VCP-21/sweep_0/DBZH");
    EXPECT_EQ(values.at("shape"), nlohmann::json::array({2, 360, 460}));
    EXPECT_EQ(values.at("chunk_grid").at("configuration").at("chunk_shape"),
              nlohmann::json::array({1, 360, 460}));
    EXPECT_EQ(all.at("VCP-21/sweep_0/DBZH_status").at("fill_value"), 3);
    const auto group = document_in(get("KBGM/VCP-21/sweep_0/zarr.json"));
    EXPECT_EQ(group.at("consolidated_metadata").at("metadata").at("DBZH"), values);
    const auto stations = document_in(get(""));
    EXPECT_EQ(stations.at("stations").at(0).at("station"), "KBGM");
}

// The values of every azimuth are those of the radial that the decoder gives there.
TEST_F(StationDoorTest, AChunkHasTheGatesOfTheSweep) {
    take_sequence(0, 2);
    const auto file = *testing::data_directory() / "sequence-kbgm" / sequence_names().at(1);
    const auto decoded = level2::decode_file(file);
    ASSERT_TRUE(decoded);
    std::size_t valid = 0;
    for (const std::string number : {"0", "1", "10"}) {
        const level2::Sweep& sweep = decoded->volume.sweeps[std::stoul(number)];
        const std::string group = "KBGM/VCP-21/sweep_" + number + "/";
        for (const auto& [name, moment] :
             {std::pair{"DBZH", level2::Moment::ref}, {"VRADH", level2::Moment::vel}}) {
            const level2::SweepMoment* const array = sweep.find(moment);
            if (array == nullptr) continue;
            const auto values = unpacked<float>(get(group + name + "/c/1/0/0"));
            const auto states = unpacked<std::uint8_t>(get(group + name + "_status/c/1/0/0"));
            const auto azimuths = unpacked<float>(get(group + "ray_azimuth/c/1/0"));
            ASSERT_EQ(azimuths.size(), 360U);
            ASSERT_EQ(states.size(), values.size());
            const auto gates = static_cast<std::int32_t>(values.size() / azimuths.size());
            // Gates of 1 km of REF may be on an axis of 250 m.
            const auto range = unpacked<float>(get(group + "range/c/0"));
            const auto repeats =
                array->gate_spacing_m / static_cast<std::int32_t>(range[1] - range[0]);
            for (std::size_t row = 0; row < azimuths.size(); ++row) {
                const auto radial =
                    std::ranges::find(sweep.radials, azimuths[row], &level2::Radial::azimuth_deg);
                if (radial == sweep.radials.end()) continue;
                const auto index = static_cast<std::size_t>(radial - sweep.radials.begin());
                for (std::int32_t gate = 0; gate < gates; ++gate) {
                    const std::int32_t own = gate / repeats;
                    const std::size_t at =
                        row * static_cast<std::size_t>(gates) + static_cast<std::size_t>(gate);
                    const GateStatus status = array->status(index, own);
                    ASSERT_EQ(states[at], static_cast<int>(status)) << row << " " << gate;
                    if (status != GateStatus::valid) continue;
                    ASSERT_EQ(values[at], array->value_of(array->code(index, own)));
                    ++valid;
                }
            }
        }
    }
    EXPECT_GT(valid, 10'000U);
    const auto angle = unpacked<double>(get("KBGM/VCP-21/sweep_10/sweep_fixed_angle/c"));
    EXPECT_NEAR(angle.at(0), 19.5, 0.2);
    EXPECT_NEAR(unpacked<double>(get("KBGM/latitude/c")).at(0), 42.2, 0.1);
    const auto text = unpacked<char>(get("KBGM/VCP-21/sweep_10/sweep_mode/c"));
    EXPECT_EQ(std::string(text.begin() + 8, text.end()), "azimuth_surveillance");
    const auto times = unpacked<std::int64_t>(get("KBGM/VCP-21/sweep_0/vcp_time/c/0"));
    EXPECT_EQ(UtcTime{milliseconds{times.at(1)}}, decoded->volume.start_time());
    EXPECT_EQ(times.at(2), no_time_ms);
}

// The radar's own records are enough for one sweep of a file of LDM records.
TEST_F(StationDoorTest, ASweepFromItsRecordsIsThatOfTheWholeVolume) {
    const std::string file = "volumes/KLOT20220317_000842_V06";
    take(file, "KLOT20220317_000842_V06");
    const auto reader = *catalog::CatalogReader::open(served_.state() / "catalog");
    const auto entry = *reader.latest("KLOT");
    ASSERT_TRUE(entry);
    DecodedVolumes decoded;
    const VolumeToDecode wanted{reader, *entry, *key_of_volume(reader, *entry)};
    const auto part = decoded.find_or_decode_cut(wanted, 5);
    ASSERT_TRUE(part && *part);
    EXPECT_EQ(decoded.find(wanted), nullptr) << "the whole volume was not decoded";
    const auto whole = decoded.find_or_decode(wanted);
    ASSERT_TRUE(whole);
    EXPECT_EQ(decoded.find(wanted), *whole);
    const auto same = std::ranges::find((*whole)->sweeps, 5, &level2::Sweep::elevation_number);
    ASSERT_NE(same, (*whole)->sweeps.end());
    const level2::Sweep& sweep = (*part)->sweeps.at(0);
    ASSERT_EQ(sweep.radials.size(), same->radials.size());
    for (std::size_t i = 0; i < sweep.moments.size(); ++i) {
        EXPECT_EQ(sweep.moments[i].codes8, same->moments[i].codes8);
        EXPECT_EQ(sweep.moments[i].codes16, same->moments[i].codes16);
    }
    const auto none = decoded.find_or_decode_cut(wanted, 99);
    EXPECT_TRUE(none && *none == nullptr);
}

TEST_F(StationDoorTest, AFileWithoutRecordsHasNoSingleSweeps) {
    take_sequence(0, 1);
    const auto reader = *catalog::CatalogReader::open(served_.state() / "catalog");
    const auto entry = *reader.latest("KBGM");
    DecodedVolumes decoded;
    const auto part =
        decoded.find_or_decode_cut({reader, *entry, *key_of_volume(reader, *entry)}, 1);
    EXPECT_TRUE(part && *part == nullptr);
}

// Patterns of one station: a volume of another pattern, and an older one of message 1.
TEST_F(StationDoorTest, EachPatternHasItsOwnGroup) {
    take("volumes/KTLX20170101_030027_V06", "KTLX20170101_030027_V06");
    take("volumes/KTLX19990503_235621.gz", "KTLX19990503_235621.gz");
    const auto all = document_in(get("KTLX/zarr.json")).at("consolidated_metadata").at("metadata");
    EXPECT_TRUE(all.contains("VCP-11/sweep_0"));
    EXPECT_TRUE(all.contains("VCP-32/sweep_0"));
    EXPECT_EQ(get("KTLX/VCP-11/sweep_0/DBZH/c/0/0/0").status, 200U);
    EXPECT_EQ(get("KTLX/VCP-11/sweep_0/DBZH/c/1/0/0").status, 404U) << "it has one volume";
    EXPECT_EQ(get("KTLX/VCP-11/sweep_0/RHOHV/c/0/0/0").status, 404U);
}

TEST_F(StationDoorTest, DecodingIsForLongWorkersAndKeptChunksAreNot) {
    take_sequence(0, 1);
    const std::string target = "/zarr3/volumes/KBGM/VCP-21/sweep_4/DBZH/c/0/0/0";
    EXPECT_FALSE(door().answer_soon(request_for("/zarr3/volumes/KBGM/zarr.json")))
        << "the first request decodes";
    ASSERT_EQ(get("KBGM/zarr.json").status, 200U);
    EXPECT_TRUE(door().answer_soon(request_for("/zarr3/volumes/KBGM/zarr.json")));
    EXPECT_TRUE(door().answer_soon(request_for("/zarr3/volumes/KBGM/VCP-21/sweep_4/azimuth/c/0")));
    EXPECT_FALSE(door().answer_soon(request_for(target)));
    const Answer made = door().answer(request_for(target));
    EXPECT_EQ(made.status, 200U);
    const auto kept = door().answer_soon(request_for(target));
    ASSERT_TRUE(kept);
    EXPECT_EQ(body_of(*kept), body_of(made));
    EXPECT_EQ(header_of(made, "Cache-Control"), "max-age=300");
    const std::string tag = header_of(made, "ETag");
    EXPECT_EQ(get("KBGM/VCP-21/sweep_4/DBZH/c/0/0/0", {{"If-None-Match", tag}}).status, 304U);
    for (const char* unknown : {"KZZZ", "AAAA", "XSYN"}) {
        const auto answer =
            door().answer_soon(request_for(std::string("/zarr3/volumes/") + unknown));
        ASSERT_TRUE(answer) << "needs no long worker";
        EXPECT_EQ(answer->status, 404U);
    }
}

TEST_F(StationDoorTest, ManyThreadsMayReadOneVolume) {
    take_sequence(0, 2);
    const std::vector<std::string> keys = {"zarr.json",
                                           "VCP-21/sweep_4/DBZH/c/0/0/0",
                                           "VCP-21/sweep_4/VRADH/c/0/0/0",
                                           "VCP-21/sweep_4/time/c/0/0",
                                           "VCP-21/sweep_5/DBZH/c/0/0/0",
                                           "VCP-21/sweep_4/DBZH/c/1/0/0",
                                           "VCP-21/sweep_4/DBZH/c/0/0/0",
                                           "VCP-21/sweep_9/RHOHV/c/0/0/0"};
    (void)door();
    std::vector<Answer> answers(keys.size());
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < keys.size(); ++i)
        threads.emplace_back([&, i] { answers[i] = get("KBGM/" + keys[i]); });
    for (std::thread& thread : threads)
        thread.join();
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const Answer alone = get("KBGM/" + keys[i]);
        EXPECT_EQ(answers[i].status, alone.status) << keys[i];
        EXPECT_EQ(body_of(answers[i]), body_of(alone)) << keys[i];
    }
    EXPECT_EQ(answers[1].status, 200U);
    EXPECT_EQ(answers.back().status, 404U) << "no radar measured correlations then";
}

// A program that opened the tree holds indices.
TEST_F(StationDoorTest, AVolumeKeepsItsIndex) {
    take_sequence(1, 2);
    const std::string chunk = "KBGM/VCP-21/sweep_0/DBZH/c/";
    const auto first = body_of(get(chunk + "0/0/0"));
    const auto second = body_of(get(chunk + "1/0/0"));
    EXPECT_NE(first, second);
    take_sequence(0, 1);  // is older than both
    take_sequence(3, 1);
    EXPECT_EQ(document_in(get("KBGM/VCP-21/sweep_0/DBZH/zarr.json")).at("shape").at(0), 4);
    EXPECT_EQ(body_of(get(chunk + "0/0/0")), first);
    EXPECT_EQ(body_of(get(chunk + "1/0/0")), second);
    std::filesystem::remove(served_.drop() / sequence_names().at(1));
    ASSERT_TRUE(served_.catalog().mark_gone(std::filesystem::canonical(served_.drop()) /
                                            sequence_names().at(1)));
    EXPECT_EQ(get(chunk + "0/0/0").status, 404U);
    door_.reset();
    EXPECT_EQ(get(chunk + "0/0/0").status, 404U);
    EXPECT_EQ(body_of(get(chunk + "1/0/0")), second);
    const auto times = unpacked<std::int64_t>(get("KBGM/VCP-21/sweep_0/vcp_time/c/0"));
    EXPECT_LT(times.at(0), times.at(1));
    EXPECT_LT(times.at(2), times.at(0));
    EXPECT_GT(times.at(3), times.at(1));
}

TEST_F(StationDoorTest, AFileThatIsNotTheCatalogedOneHasNoValues) {
    take_sequence(0, 3);
    const auto names = sequence_names();
    const auto drop = served_.drop();
    ASSERT_EQ(get("KBGM/zarr.json").status, 200U);
    std::filesystem::copy_file(drop / names.at(2), drop / names.at(1),
                               std::filesystem::copy_options::overwrite_existing);
    const std::string chunk = "KBGM/VCP-21/sweep_0/DBZH/c/";
    EXPECT_EQ(get(chunk + "1/0/0").status, 404U);
    EXPECT_EQ(get(chunk + "2/0/0").status, 200U);
    std::filesystem::remove(drop / names.at(2));
    EXPECT_EQ(get("KBGM/VCP-21/sweep_7/DBZH/c/2/0/0").status, 200U) << "it is still decoded";
    EXPECT_EQ(get("KBGM/VCP-21/sweep_7/DBZH/c/1/0/0").status, 404U);
    const Answer gone = get(chunk + "1/0/0");
    EXPECT_EQ(body_of(gone).find(drop.native()), std::string::npos) << "clients see no paths";
}

TEST_F(StationDoorTest, AVolumeOfChunksIsOneVolume) {
    served_.take_chunks(55);
    const auto all = document_in(get("KLOT/zarr.json")).at("consolidated_metadata").at("metadata");
    std::string pattern;
    for (const auto& [path, node] : all.items())
        if (path.starts_with("VCP-") && path.find('/') == std::string::npos) pattern = path;
    EXPECT_EQ(all.at(pattern + "/sweep_0/vcp_time").at("shape").at(0), 1);
    EXPECT_EQ(get("KLOT/" + pattern + "/sweep_0/DBZH/c/0/0/0").status, 200U);
}

TEST_F(StationDoorTest, WhatIsNotThereIsRefused) {
    take_sequence(0, 1);
    for (const char* key : {"KBGM",
                            "KBGM/",
                            "KBGM/VCP-21",
                            "KBGM/VCP-21/sweep_0",
                            "KBGM/.zgroup",
                            "KBGM/.zmetadata",
                            "KBGM/VCP-22/zarr.json",
                            "KBGM/VCP-21/sweep_00/zarr.json",
                            "KBGM/VCP-21/sweep_99/zarr.json",
                            "KBGM/VCP-21/sweep_0/DBZH",
                            "KBGM/VCP-21/sweep_0/DBZH/c",
                            "KBGM/VCP-21/sweep_0/DBZH/c/0",
                            "KBGM/VCP-21/sweep_0/DBZH/c/0/0",
                            "KBGM/VCP-21/sweep_0/DBZH/c/0/0/0/0",
                            "KBGM/VCP-21/sweep_0/DBZH/c/1/0/0",
                            "KBGM/VCP-21/sweep_0/DBZH/c/0/1/0",
                            "KBGM/VCP-21/sweep_0/DBZH/c/-1/0/0",
                            "KBGM/VCP-21/sweep_0/DBZH/c/00/0/0",
                            "KBGM/VCP-21/sweep_0/DBZH/c/0/0/99999999999999999999",
                            "KBGM/VCP-21/sweep_0/DBZH/0/0/0",
                            "KBGM/VCP-21/sweep_0/sweep_mode/c/0",
                            "KBGM/VCP-21/sweep_0/azimuth/c/1",
                            "KBGM/VCP-21/c/0",
                            "KBGM/latitude/c/0",
                            "KBGM/a/b/c/d/e/f",
                            "kbgm/zarr.json",
                            "KZZZ/zarr.json",
                            "KBGMX/zarr.json"}) {
        EXPECT_EQ(get(key).status, 404U) << key;
    }
    EXPECT_FALSE(std::filesystem::exists(numbers_ / "KZZZ"));
    EXPECT_TRUE(std::filesystem::exists(numbers_ / "KBGM/VCP-21.times"));
}

TEST_F(StationDoorTest, MomentsOfADomainOfThisNameStayWhereTheyAre) {
    EXPECT_EQ(body_of(get("REF/zarr.json")), "a domain of this name\n");
    EXPECT_EQ(body_of(get("mesh/zarr.json")), "a domain of this name\n");
}

TEST_F(StationDoorTest, NoCatalogIsNoStation) {
    StationDoor door(
        std::make_shared<StationTrees>(StationTreesOptions{
            .catalog = served_.state() / "none", .numbers = std::make_shared<TimeNumbers>("")}),
        std::make_shared<KeptAnswers>(1000), nullptr);
    EXPECT_EQ(asked(door, "/zarr3/volumes/KBGM/zarr.json").status, 404U);
    EXPECT_EQ(document_in(asked(door, "/zarr3/volumes")).at("stations").size(), 0U);
}

}  // namespace
}  // namespace stormcellar::web
