// Tests the lists of volumes and sweeps, and which sweeps are marked for pictures.
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "grid/place/source_volume.h"
#include "retrieve/wind/station_profile.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "tests/web/served_volumes.h"
#include "web/data/grids/packed_sweep.h"
#include "web/service/sources.h"

namespace stormcellar::web {
namespace {

// Doors (handlers of a path) of the data server, which answer from one catalog.
class OpenDoors {
  public:
    explicit OpenDoors(const ServedVolumes& volumes,
                       const std::vector<WebPart>& serve = WebConfig{}.serve) {
        WebSetup setup;
        setup.web.serve = serve;
        setup.catalog = volumes.state() / "catalog";
        setup.cache = cache_.path();
        doors_ = doors_to(open_sources(setup).value(), measures_);
    }
    Answer get(const std::string& path) { return asked(*doors_->find(path), path); }
    // Returns none if the answer takes long.
    std::optional<Answer> get_soon(const std::string& path) {
        return doors_->find(path)->answer_soon(request_for(path));
    }

  private:
    testing::TemporaryDirectory cache_;
    Measures measures_;
    std::shared_ptr<const Doors> doors_;
};

// 2026-11-29: the page offered raw files although the server did not serve them.
TEST(ApiVolumes, NameNoFileWhereNoneAreGiven) {
    STORMCELLAR_NEED_DATA();
    const ServedVolumes volumes;
    const auto newest = [&](OpenDoors&& doors) {
        const Answer answer = doors.get("/api/v1/stations/KTLX/volumes");
        return nlohmann::json::parse(body_of(answer)).at("volumes").back();
    };
    EXPECT_EQ(newest(OpenDoors(volumes)).at("raw"), "KTLX20170101_030027_V06");
    const auto without = newest(OpenDoors(volumes, {WebPart::grids}));
    EXPECT_TRUE(without.at("raw").is_null()) << without;
    EXPECT_EQ(without.at("name"), "KTLX20170101_030027_V06");
}

// 2026-11-28: for split cuts the page showed the reflectivity of the Doppler sweeps, with
// range-folded echo and half of the range.
TEST(ApiSweeps, SayWhichOfThemAPictureOfEachMomentShows) {
    STORMCELLAR_NEED_DATA();
    const ServedVolumes volumes;
    OpenDoors doors(volumes);
    const std::string path = "/api/v1/stations/KTLX/volumes/2017-01-01T03:00:27Z/sweeps";
    const Answer answer = doors.get(path);
    ASSERT_EQ(answer.status, 200U) << body_of(answer);
    // In the table of `stormcellar info`, sweeps 0 and 2 are surveillance, and 1 and 3 the Doppler
    // sweeps of the same cuts.
    std::map<std::string, std::vector<int>> chosen;
    std::vector<std::string> waveforms;
    const auto list = nlohmann::json::parse(body_of(answer)).at("sweeps");
    for (const auto& sweep : list) {
        waveforms.push_back(sweep.value("waveform", ""));
        for (const auto& moment : sweep.at("moments")) {
            if (moment.at("chosen").get<bool>())
                chosen[moment.at("moment")].push_back(sweep.at("sweep"));
        }
    }
    EXPECT_EQ(chosen["REF"], (std::vector<int>{0, 2, 4, 5, 6}));
    EXPECT_EQ(chosen["VEL"], (std::vector<int>{1, 3, 4, 5, 6}));
    EXPECT_EQ(chosen["ZDR"], (std::vector<int>{0, 2, 4, 5, 6}));
    EXPECT_EQ(waveforms, (std::vector<std::string>{"CS", "CD/W", "CS", "CD/W", "B", "B", "B"}));
}

TEST(ApiSweeps, GatesOfADerivedMomentComeOrAReasonDoes) {
    STORMCELLAR_NEED_DATA();
    const ServedVolumes volumes;
    OpenDoors doors(volumes);
    const std::string sweep = "/api/v1/stations/KTLX/volumes/2017-01-01T03:00:27Z/sweeps/1/";
    const Answer dealiased = doors.get(sweep + "VELD");
    EXPECT_EQ(dealiased.status, 200U) << body_of(dealiased);
    for (const char* moment : {"AZSH", "DIVG"}) {
        const Answer shear = doors.get(sweep + moment);
        EXPECT_EQ(shear.status, 200U) << body_of(shear);
    }
    const Answer relative = doors.get(sweep + "SRV");
    EXPECT_EQ(relative.status, 404U);
    EXPECT_THAT(body_of(relative), ::testing::HasSubstr("gives no storm motion: the highest wind"));
}

// The server gives the profile that the library measures, and computes it once, in a worker.
TEST(ApiWind, IsTheProfileOfTheVolumeOrAReason) {
    STORMCELLAR_NEED_DATA();
    const ServedVolumes volumes;
    OpenDoors doors(volumes);
    const std::string stations = "/api/v1/stations/";
    const std::string path = stations + "KTLX/volumes/2017-01-01T03:00:27Z/wind";
    EXPECT_FALSE(doors.get_soon(path)) << "computing takes long";
    const Answer answer = doors.get(path);
    ASSERT_EQ(answer.status, 200U) << body_of(answer);
    const char* const name = "KTLX20170101_030027_V06";
    const auto volume =
        level2::decode_file(testing::real_file(std::string("volumes/") + name))->volume;
    const auto profile = retrieve::station_profile(volume, name);
    ASSERT_TRUE(profile) << profile.error().message;
    ASSERT_TRUE(profile->has_wind());
    EXPECT_EQ(nlohmann::ordered_json::parse(body_of(answer)), retrieve::profile_json(*profile));
    EXPECT_EQ(header_of(answer, "Cache-Control"), "max-age=300");
    const auto again = doors.get_soon(path);
    ASSERT_TRUE(again) << "kept";
    EXPECT_EQ(header_of(*again, "ETag"), header_of(answer, "ETag"));

    const Answer latest = doors.get(stations + "KTLX/volumes/latest/wind");
    EXPECT_EQ(body_of(latest), body_of(answer));
    EXPECT_EQ(header_of(latest, "Cache-Control"), "no-cache");
    EXPECT_EQ(doors.get(stations + "KTLX/volumes/2017-01-02T00:00:00Z/wind").status, 404U);
    EXPECT_EQ(doors.get(stations + "KTLX/volumes/yesterday/wind").status, 400U);
    EXPECT_EQ(doors.get(path + "?layer=200").status, 400U);
}

// The file ends in its first sweep, which has no velocities.
TEST(ApiWind, OfAVolumeWithoutVelocitiesIsNotFound) {
    STORMCELLAR_NEED_DATA();
    ServedVolumes volumes(false);
    const std::string name = "KATX20160427_095248_V06.gz";
    (void)volumes.take(testing::real_file("volumes/" + name), name);
    OpenDoors doors(volumes);
    const Answer answer = doors.get("/api/v1/stations/KATX/volumes/latest/wind");
    EXPECT_EQ(answer.status, 404U);
    EXPECT_THAT(body_of(answer), ::testing::HasSubstr("the volume has no velocities"));
}

// VELD is listed beside VEL and chosen with it. Its gates are those that the library derives.
TEST(ApiSweeps, HaveTheDealiasedVelocityBesideTheVelocity) {
    STORMCELLAR_NEED_DATA();
    const ServedVolumes volumes;
    OpenDoors doors(volumes);
    const std::string path = "/api/v1/stations/KTLX/volumes/2017-01-01T03:00:27Z/sweeps";
    const auto volume =
        level2::decode_file(testing::real_file("volumes/KTLX20170101_030027_V06"))->volume;
    const auto dealiased =
        retrieve::derived_velocities(volume, std::array{level2::Moment::veld}).value().volume;
    int derived = 0;
    const auto list = nlohmann::json::parse(body_of(doors.get(path))).at("sweeps");
    for (const auto& sweep : list) {
        const auto& moments = sweep.at("moments");
        for (std::size_t i = 0; i < moments.size(); ++i) {
            if (moments[i].at("moment") != "VELD") continue;
            ++derived;
            auto expected = moments.at(i - 1);
            EXPECT_EQ(expected.at("moment"), "VEL");
            expected["moment"] = "VELD";
            expected["bits"] = 16;
            EXPECT_EQ(moments[i], expected);
        }
        EXPECT_EQ(moments.dump().find("VELD") != std::string::npos,
                  moments.dump().find("\"VEL\"") != std::string::npos);
    }
    EXPECT_EQ(derived, 5);

    const Answer answer = doors.get(path + "/1/VELD");
    ASSERT_EQ(answer.status, 200U) << body_of(answer);
    const std::string bytes = body_of(answer);
    PackedSweepHeader header;
    ASSERT_GE(bytes.size(), sizeof header);
    std::memcpy(&header, bytes.data(), sizeof header);
    EXPECT_EQ(header.moment, static_cast<std::uint32_t>(level2::Moment::veld));
    EXPECT_EQ(header.code_bytes, 2U);
    EXPECT_EQ(header.first_valid_code, 3U) << "code 2 is ambiguous";
    const level2::SweepMoment& made = *dealiased.sweeps.at(1).find(level2::Moment::veld);
    EXPECT_EQ(header.scale, made.scale);
    EXPECT_EQ(header.offset, made.offset);
    ASSERT_EQ(bytes.size(), header.codes_offset + 2 * made.codes16.size());
    EXPECT_EQ(std::memcmp(bytes.data() + header.codes_offset, made.codes16.data(),
                          2 * made.codes16.size()),
              0);
    EXPECT_EQ(doors.get(path + "/0/VELD").status, 404U) << "a surveillance sweep has no velocity";
    EXPECT_EQ(body_of(doors.get(path + "/1/VELD")), bytes)
        << "the second answer is the kept answer";
}

// With ?quality=0.5, the answer has the gates that the library keeps at this limit, and its header
// has the share of the sweep that is left out.
TEST(ApiSweeps, LackEchoThatIsProbablyNoWeatherOnRequest) {
    STORMCELLAR_NEED_DATA();
    const ServedVolumes volumes;
    OpenDoors doors(volumes);
    const auto volume =
        level2::decode_file(testing::real_file("volumes/KTLX20170101_030027_V06"))->volume;
    retrieve::DerivedOptions options;
    options.quality = 0.5;
    const auto weather =
        retrieve::derived_velocities(volume, std::array{level2::Moment::veld}, options);
    ASSERT_TRUE(weather);
    const std::string path = "/api/v1/stations/KTLX/volumes/2017-01-01T03:00:27Z/sweeps/";
    const auto valid = [](const level2::Volume& of, std::size_t sweep, level2::Moment moment) {
        const level2::SweepMoment& gates = *of.sweeps.at(sweep).find(moment);
        double count = 0;
        for (std::size_t radial = 0; radial < gates.gate_counts.size(); ++radial)
            for (std::int32_t gate = 0; gate < gates.gate_counts[radial]; ++gate)
                count += gates.status(radial, gate) == level2::GateStatus::valid ? 1 : 0;
        return count;
    };
    for (const auto& [sweep, moment, counted] :
         {std::tuple{0, level2::Moment::ref, level2::Moment::ref},
          {1, level2::Moment::vel, level2::Moment::vel},
          {1, level2::Moment::veld, level2::Moment::vel}}) {
        const std::string gates = fmt::format("{}{}/{}", path, sweep, level2::moment_name(moment));
        SCOPED_TRACE(gates);
        const std::string bytes = body_of(doors.get(gates + "?quality=0.5"));
        PackedSweepHeader header;
        ASSERT_GE(bytes.size(), sizeof header);
        std::memcpy(&header, bytes.data(), sizeof header);
        const auto at = static_cast<std::size_t>(sweep);
        const level2::SweepMoment& made = *weather->volume.sweeps.at(at).find(moment);
        const std::string_view codes =
            made.word_size_bits == 8
                ? std::string_view(reinterpret_cast<const char*>(made.codes8.data()),
                                   made.codes8.size())
                : std::string_view(reinterpret_cast<const char*>(made.codes16.data()),
                                   2 * made.codes16.size());
        EXPECT_TRUE(std::string_view(bytes).substr(header.codes_offset) == codes);
        EXPECT_EQ(header.least_probability, 0.5F);
        EXPECT_GT(header.left_out_share, 0.1F);
        EXPECT_NEAR(header.left_out_share,
                    1 - valid(weather->volume, at, counted) / valid(volume, at, counted), 1e-6);
        const std::string all = body_of(doors.get(gates));
        std::memcpy(&header, all.data(), sizeof header);
        EXPECT_EQ(header.least_probability, 0);
        EXPECT_EQ(header.left_out_share, 0);
        EXPECT_NE(all, bytes);
        EXPECT_EQ(body_of(doors.get(gates + "?quality=0")).substr(0, all.size()), all);
    }
    for (const char* refused : {"-0.1", "1.5", "half", "nan"})
        EXPECT_EQ(doors.get(path + "0/REF?quality=" + refused).status, 400U) << refused;
}

// 2026-11-28: a volume that came as chunks was decoded once, so its list never got later sweeps.
TEST(ApiSweeps, OfAVolumeThatGrowsAreThoseThatHaveCome) {
    STORMCELLAR_NEED_DATA();
    ServedVolumes volumes(false);
    std::set<std::size_t> counts;
    (void)volumes.take_chunks(4);
    OpenDoors doors(volumes);
    for (const std::size_t chunks : {10U, 25U, 55U}) {
        (void)volumes.take_chunks(chunks);
        const std::string path = "/api/v1/stations/KLOT/volumes/latest/sweeps";
        const Answer answer = doors.get(path);
        ASSERT_EQ(answer.status, 200U) << body_of(answer);
        counts.insert(nlohmann::json::parse(body_of(answer)).at("sweeps").size());
    }
    EXPECT_EQ(counts.size(), 3U);
}

// 2026-11-28: the row of a volume counted all chunks before the last chunk had a row. The sweeps
// that were read at that moment were kept.
TEST(ApiSweeps, OfAVolumeWhoseRowIsAheadAreReadAgain) {
    STORMCELLAR_NEED_DATA();
    ServedVolumes whole(false);
    (void)whole.take_chunks(55);
    const auto facts = whole.catalog().list("KLOT", {})->at(0).volume;
    ServedVolumes volumes(false);
    (void)volumes.take_chunks(54);
    const catalog::CatalogEntry row = volumes.catalog().list("KLOT", {})->at(0);
    ASSERT_TRUE(volumes.catalog().register_file({row.path,
                                                 "KLOT",
                                                 row.size_bytes,
                                                 row.modified_ns,
                                                 row.content_hash,
                                                 row.state,
                                                 {},
                                                 {facts}}));
    OpenDoors doors(volumes);
    const auto last_sweep = [&] {
        const Answer answer = doors.get("/api/v1/stations/KLOT/volumes/latest/sweeps");
        EXPECT_EQ(answer.status, 200U) << body_of(answer);
        return nlohmann::json::parse(body_of(answer)).at("sweeps").back();
    };
    const auto early = last_sweep();
    (void)volumes.take_chunks(55);
    EXPECT_LT(early.at("radials"), 360);
    EXPECT_EQ(last_sweep().at("radials"), 360);
}

// 2026-11-28: a station whose database could not be read was listed as silent and without a volume.
TEST(ApiStations, ADatabaseThatCannotBeReadSaysNothing) {
    STORMCELLAR_NEED_DATA();
    const ServedVolumes volumes;
    const auto database = volumes.state() / "catalog/KTLX.sqlite";
    for (const char* const ending : {"", "-wal", "-shm"})
        std::filesystem::remove(database.native() + ending);
    std::ofstream(database) << std::string(8192, 'x');
    OpenDoors doors(volumes);
    const Answer answer = doors.get("/api/v1/stations");
    ASSERT_EQ(answer.status, 200U) << body_of(answer);
    std::map<std::string, bool> is_known;
    const auto list = nlohmann::json::parse(body_of(answer)).at("stations");
    for (const auto& station : list) {
        const bool has_both = station.contains("newest_volume") && station.contains("silent_s");
        is_known[station.at("station")] = has_both;
    }
    EXPECT_EQ(is_known, (std::map<std::string, bool>{{"KABR", true}, {"KTLX", false}}));
}

// 2026-11-28: if one of two files of a volume was deleted, the volume was reported as gone.
TEST(ApiSweeps, AFileThatIsLeftIsTaken) {
    STORMCELLAR_NEED_DATA();
    ServedVolumes volumes(false);
    const auto file = *testing::data_directory() / "volumes/KTLX20170101_030027_V06";
    (void)volumes.take(file, "KTLX20170101_030027_V06");
    (void)volumes.take(file, "copy_KTLX20170101_030027_V06");
    ASSERT_TRUE(volumes.catalog().mark_gone(std::filesystem::canonical(volumes.drop()) /
                                            "copy_KTLX20170101_030027_V06"));
    OpenDoors doors(volumes);
    for (const std::string time : {"2017-01-01T03:00:27Z", "latest"}) {
        const std::string path = "/api/v1/stations/KTLX/volumes/" + time + "/sweeps";
        EXPECT_EQ(doors.get(path).status, 200U) << time;
    }
}

// 2026-11-28: if a file had two volumes, the second volume got the gates and pictures of the first.
TEST(ApiSweeps, EachOfTwoVolumesInAFileHasItsOwnGates) {
    STORMCELLAR_NEED_DATA();
    ServedVolumes volumes(false);
    const testing::TemporaryDirectory directory;
    const std::filesystem::path both = directory / "KBGM20050822_024414.gz";
    std::vector<std::byte> bytes;
    for (const char* const name : {"KBGM20050822_024414.gz", "KBGM20050822_025001.gz"}) {
        const auto one = read_file(*testing::data_directory() / "sequence-kbgm" / name);
        ASSERT_TRUE(one);
        bytes.insert(bytes.end(), one->begin(), one->end());
    }
    std::ofstream(both, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    ASSERT_NE(volumes.take(both, both.filename()), pipeline::IngestResult::rejected);
    OpenDoors doors(volumes);
    const auto gates_of = [&](const char* start) {
        const std::string path =
            std::string("/api/v1/stations/KBGM/volumes/") + start + "/sweeps/0/REF";
        const Answer answer = doors.get(path);
        EXPECT_EQ(answer.status, 200U) << body_of(answer);
        return body_of(answer);
    };
    EXPECT_NE(gates_of("2005-08-22T02:44:14Z"), gates_of("2005-08-22T02:50:01Z"));

    grid::SourceWish wish{.moments = {level2::Moment::ref}};
    const auto first = grid::decode_source(bytes, "KBGM", wish);
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_EQ(format_utc(*first->volume.start_time()), "2005-08-22T02:44:14Z");
    wish.start = *parse_utc("2005-08-22T02:50:01Z", UtcTime{});
    wish.choose_cuts = [](const level2::Volume&) { return std::vector<int>{1}; };
    const auto second = grid::decode_source(bytes, "KBGM", wish);
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_EQ(second->volume.start_time(), wish.start);
    wish.start = *wish.start + std::chrono::seconds{1};
    EXPECT_EQ(grid::decode_source(bytes, "KBGM", wish).error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace stormcellar::web
