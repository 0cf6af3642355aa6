#include "daemon/config/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/grid/grid_spec.h"
#include "tests/daemon/write_file.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

class ConfigFile : public ::testing::Test {
  protected:
    Result<Config> load(const std::string& text) {
        write_file(file(), text);
        return load_config(file());
    }
    // Returns the message without the directory, which differs in each run.
    std::string complaint(const std::string& text) {
        const Result<Config> config = load(text);
        if (config) return "no complaint";
        EXPECT_EQ(config.error().code, ErrorCode::bad_argument);
        EXPECT_EQ(config.error().message.find('\n'), std::string::npos) << config.error().message;
        const std::string directory = directory_.path().native() + "/";
        EXPECT_TRUE(config.error().message.starts_with(directory)) << config.error().message;
        return config.error().message.substr(directory.size());
    }
    [[nodiscard]] std::filesystem::path file() const { return directory_ / "s.toml"; }

    testing::TemporaryDirectory directory_;
};

constexpr const char* paths = "[paths]\ndrop = \"/d\"\nstate = \"/s\"\ncache = \"/c\"\n";

TEST_F(ConfigFile, ShippedFileHoldsEveryDefault) {
    Result<Config> shipped = load_config(testing::source_directory() / "daemon/stormcellard.toml");
    ASSERT_TRUE(shipped) << shipped.error().message;
    const Result<Config> bare = load("[paths]\ndrop = \"/var/spool/ldm/nexrad2\"\n");
    ASSERT_TRUE(bare) << bare.error().message;
    // Without the key, the grid library uses its default list, which the shipped file spells out.
    EXPECT_TRUE(bare->fixed.grid.levels_m.empty());
    EXPECT_EQ(shipped->fixed.grid.levels_m, grid::default_spec(0, 0).levels_m);
    shipped->fixed.grid.levels_m.clear();
    EXPECT_TRUE(shipped->fixed.paths == bare->fixed.paths);
    EXPECT_TRUE(shipped->fixed.grid == bare->fixed.grid);
    EXPECT_TRUE(shipped->fixed.ingest == bare->fixed.ingest);
    EXPECT_TRUE(shipped->fixed.storage == bare->fixed.storage);
    EXPECT_TRUE(shipped->fixed.status == bare->fixed.status);
    EXPECT_TRUE(shipped->reloadable == bare->reloadable);
    EXPECT_TRUE(*shipped == *bare);
    Config defaults;
    defaults.fixed.paths.drop = "/var/spool/ldm/nexrad2";
    defaults.fixed.grid.threads = bare->fixed.grid.threads;
    EXPECT_TRUE(*bare == defaults) << "only the numbers of threads depend on the machine";
}

TEST_F(ConfigFile, EveryKeyIsTaken) {
    const Result<Config> config =
        load(std::string(paths) +
             "[ingest]\nworkers = 3\nthreads = 2\nquiet_seconds = 1.5\n"
             "reread_seconds = 0\nchunk_timeout_seconds = 300\nchunk_grace_seconds = 0\nliving = "
             "false\nbunzip = \"libbz2\"\nmoment = \"VEL\"\nspacing_km = 0.5\n"
             "extent_km = [100, 50]\nlevels_km = [0.5, 1, 2.5]\n"
             "[cache]\nrefill_hours = 0.5\ncompression = \"lz4\"\n[catalog]\ngone_days = 1.5\n"
             "[watch]\nrescan_seconds = 7\npoll_seconds = 2\nqueue_limit = 99\n"
             "[log]\nlevel = \"debug\"\n");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->fixed.paths.drop, "/d");
    EXPECT_EQ(config->fixed.paths.state, "/s");
    EXPECT_EQ(config->fixed.paths.cache, "/c");
    EXPECT_EQ(config->reloadable.worker_count(), 3);
    EXPECT_EQ(config->fixed.grid.threads, 2);
    EXPECT_EQ(config->reloadable.quiet, std::chrono::milliseconds{1500});
    EXPECT_EQ(config->reloadable.reread, std::chrono::milliseconds{0});
    EXPECT_FALSE(config->fixed.ingest.living);
    EXPECT_EQ(config->fixed.ingest.bunzip, bunzip::Path::libbz2);
    EXPECT_EQ(config->fixed.storage.refill, std::chrono::minutes{30});
    EXPECT_EQ(config->fixed.storage.packing, cache::Packing::lz4);
    EXPECT_EQ(config->reloadable.gone_rows_kept_for, std::chrono::hours{36});
    EXPECT_EQ(config->fixed.grid.moments, std::vector{level2::Moment::vel});
    EXPECT_EQ(config->fixed.grid.spacing_m, 500);
    EXPECT_EQ(config->fixed.grid.nx, 200);
    EXPECT_EQ(config->fixed.grid.ny, 100);
    EXPECT_EQ(config->fixed.grid.levels_m, (std::vector<double>{500, 1000, 2500}));
    EXPECT_EQ(config->reloadable.rescan, std::chrono::seconds{7});
    EXPECT_EQ(config->reloadable.poll, std::chrono::seconds{2});
    EXPECT_EQ(config->fixed.queue_limit, 99U);
    EXPECT_EQ(config->reloadable.log_level, "debug");
}

TEST_F(ConfigFile, MomentsAreAListOrTheOldKeyWithOneName) {
    using level2::Moment;
    EXPECT_EQ(load(paths)->fixed.grid.moments, std::vector{Moment::ref});
    const auto moments_of = [&](const std::string& line) {
        return load(std::string(paths) + "[ingest]\n" + line + "\n")->fixed.grid.moments;
    };
    EXPECT_EQ(moments_of("moment = \"VEL\""), std::vector{Moment::vel});
    EXPECT_EQ(moments_of("moments = [\"VEL\", \"REF\", \"VEL\"]"),
              (std::vector{Moment::vel, Moment::ref}));
    const auto refused = [&](const std::string& lines) {
        const auto config = load(std::string(paths) + "[ingest]\n" + lines);
        return config ? std::string{} : config.error().message;
    };
    EXPECT_NE(refused("moments = []\n").find("must name at least one moment"), std::string::npos);
    EXPECT_NE(refused("moments = [\"REF\", \"REFL\"]\n").find("\"REFL\" is not a moment"),
              std::string::npos);
    EXPECT_NE(refused("moments = [\"REF\", \"HCA\"]\n").find("HCA has classes"), std::string::npos);
    EXPECT_NE(refused("moment = \"REF\"\nmoments = [\"REF\"]\n").find("give one of the two"),
              std::string::npos);
}

TEST_F(ConfigFile, DealiasingIsARungAndDerivedMomentsNeedIt) {
    using retrieve::Dealiasing;
    EXPECT_EQ(load(paths)->fixed.grid.dealiasing, Dealiasing::automatic);
    const auto loaded = [&](const std::string& lines) {
        return load(std::string(paths) + "[ingest]\n" + lines);
    };
    EXPECT_EQ(loaded("dealias = \"region\"\n")->fixed.grid.dealiasing, Dealiasing::region);
    EXPECT_EQ(loaded("dealias = \"off\"\nmoments = [\"VEL\"]\n")->fixed.grid.dealiasing,
              Dealiasing::off);
    const auto refused = [&](const std::string& lines) {
        const auto config = loaded(lines);
        return config ? std::string{} : config.error().message;
    };
    EXPECT_NE(refused("dealias = \"fast\"\n").find("off, auto, profile, region or anchored"),
              std::string::npos);
    for (const char* moment : {"VELD", "SRV", "AZSH"}) {
        EXPECT_NE(refused(fmt::format("dealias = \"off\"\nmoments = [\"REF\", \"{}\"]\n", moment))
                      .find(fmt::format("does not go with the moment {}", moment)),
                  std::string::npos);
    }
}

TEST_F(ConfigFile, QualityIsAProbability) {
    EXPECT_EQ(load(paths)->fixed.grid.quality, 0);
    const auto loaded = [&](const std::string& value) {
        return load(std::string(paths) + "[ingest]\nquality = " + value + "\n");
    };
    EXPECT_EQ(loaded("0.5")->fixed.grid.quality, 0.5);
    EXPECT_EQ(loaded("1")->fixed.grid.quality, 1);
    for (const char* refused : {"-0.1", "1.1", "50", "nan", "\"0.5\""}) {
        const auto config = loaded(refused);
        ASSERT_FALSE(config) << refused;
        EXPECT_NE(config.error().message.find("[ingest] quality: "), std::string::npos)
            << config.error().message;
    }
}

TEST_F(ConfigFile, StationsAreKnownOrAnyOrAList) {
    EXPECT_EQ(load(paths)->fixed.ingest.stations, StationRule{});
    const auto rule_of = [&](const std::string& value) {
        return load(std::string(paths) + "[ingest]\nstations = " + value + "\n")
            ->fixed.ingest.stations;
    };
    EXPECT_EQ(rule_of("\"known\""), StationRule{});
    EXPECT_EQ(rule_of("\"any\""), StationRule::any());
    EXPECT_EQ(rule_of("[\"KTLX\", \"XABC\"]"), StationRule::listed({"KTLX", "XABC"}));
    const auto complaint_of = [&](const std::string& value) {
        return complaint(std::string(paths) + "[ingest]\nstations = " + value + "\n");
    };
    EXPECT_EQ(complaint_of("\"all\""),
              "s.toml:6: [ingest] stations: \"all\" must be known, any or a list of stations");
    EXPECT_EQ(complaint_of("[]"),
              "s.toml:6: [ingest] stations: must name a station, or be left out");
    EXPECT_EQ(complaint_of("[\"ktlx\"]"),
              "s.toml:6: [ingest] stations: \"ktlx\" is not a station: give four capital letters "
              "or digits, as in \"KTLX\"");
}

TEST_F(ConfigFile, StationsAreAddedToTheTable) {
    const Result<Config> config =
        load(std::string(paths) +
             "[[station]]\nicao = \"XABC\"\nname = \"Research\"\nlatitude_deg = 35.5\n"
             "longitude_deg = -97\nantenna_altitude_m = 400\n");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->fixed.ingest.added_stations,
              (std::vector<AddedStation>{{"XABC", "Research", 35.5, -97, 400}}));
    const std::string place = "latitude_deg = 1\nlongitude_deg = 2\nantenna_altitude_m = 3\n";
    const auto complaint_of = [&](const std::string& text) {
        return complaint(std::string(paths) + "[[station]]\n" + text);
    };
    EXPECT_EQ(complaint_of("icao = \"KTLX\"\n" + place),
              "s.toml:6: [station] icao: KTLX is already in the station table");
    EXPECT_EQ(complaint_of("icao = \"x\"\n" + place),
              "s.toml:6: [station] icao: \"x\" is not a station: give four capital letters or "
              "digits, as in \"KTLX\"");
    EXPECT_EQ(complaint_of(place), "s.toml:5: [station] icao: must be given");
    EXPECT_EQ(complaint_of("icao = \"XABC\"\nlatitude_deg = 91\nlongitude_deg = 2\n"
                           "antenna_altitude_m = 3\n")
                  .substr(0, 34),
              "s.toml:7: [station] latitude_deg: ");
    EXPECT_EQ(complaint_of("icao = \"XABC\"\n"), "s.toml:5: [station] latitude_deg: must be given");
}

TEST_F(ConfigFile, BudgetsOfTheCacheAndOfItsDomains) {
    const Result<Config> config =
        load(std::string(paths) +
             "[cache]\nbytes = \"20 GB\"\npercent = 80.5\nage_hours = 48\nlow_watermark = 0.8\n"
             "protect_hours = 0.5\n"
             "[[cache.domain]]\nname = \"KTLX\"\nbytes = 500000\n"
             "[[cache.domain]]\nname = \"*\"\nage_hours = 0.5\npercent = 70\n");
    ASSERT_TRUE(config) << config.error().message;
    const cache::Budgets& budgets = config->reloadable.budgets;
    EXPECT_EQ(budgets.total.bytes, 20'000'000'000U);
    EXPECT_EQ(budgets.total.file_system_percent, 80.5);
    EXPECT_EQ(budgets.total.age, std::chrono::hours{48});
    EXPECT_EQ(budgets.low_watermark, 0.8);
    EXPECT_EQ(budgets.protected_for, std::chrono::minutes{30});
    EXPECT_EQ(budgets.of("KTLX").bytes, 500'000U);
    EXPECT_EQ(budgets.of("KTLX").file_system_percent, std::nullopt);
    EXPECT_EQ(budgets.of("KBGM").age, std::chrono::minutes{30});
    EXPECT_EQ(budgets.of("KBGM").file_system_percent, 70);
    EXPECT_EQ(budgets.age_of("KTLX"), std::chrono::hours{48});
    EXPECT_EQ(budgets.age_of("KBGM"), std::chrono::minutes{30});

    const Result<Config> none = load(std::string(paths) + "[cache]\nbytes = 0\npercent = 0\n");
    ASSERT_TRUE(none);
    EXPECT_EQ(none->reloadable.budgets, cache::Budgets{}) << "0 means no limit";
    EXPECT_EQ(none->reloadable.budgets.protected_for, std::chrono::hours{168});
}

TEST_F(ConfigFile, BudgetsThatMakeNoSenseAreRefused) {
    const std::string p = std::string(paths) + "[cache]\n";
    EXPECT_EQ(
        complaint(p + "bytes = \"20 XB\"\n"),
        "s.toml:6: [cache] bytes: '20 XB' is not an amount of bytes such as 20 GB, 512 MiB or 0");
    EXPECT_EQ(complaint(p + "bytes = -1\n").substr(0, 36), "s.toml:6: [cache] bytes: -1 is out o");
    EXPECT_EQ(complaint(p + "percent = 101\n").substr(0, 9), "s.toml:6:");
    EXPECT_EQ(complaint(p + "low_watermark = 0\n").substr(0, 9), "s.toml:6:");
    EXPECT_EQ(complaint(p + "protect_hours = -1\n").substr(0, 9), "s.toml:6:");
    EXPECT_EQ(complaint(p + "byte = 1\n"), "s.toml:6: unknown key [cache] byte");
    EXPECT_EQ(complaint(p + "[[cache.domain]]\nbytes = 1\n"),
              "s.toml:6: [cache.domain] name: must be given");
    EXPECT_EQ(complaint(p + "[[cache.domain]]\nname = \"a.KBOX\"\n"),
              "s.toml:7: [cache.domain] name: \"a.KBOX\" is not a valid name of a domain");
    EXPECT_EQ(complaint(p + "[[cache.domain]]\nname = \"a\"\n[[cache.domain]]\nname = \"a\"\n"),
              "s.toml:9: [cache.domain] name: \"a\" is named twice");
}

TEST_F(ConfigFile, NoWorkersMeansOneForEachProcessor) {
    const Result<Config> config = load(paths);
    ASSERT_TRUE(config);
    EXPECT_GE(config->reloadable.worker_count(), 1);
    EXPECT_GE(config->fixed.grid.threads, 1);
}

TEST_F(ConfigFile, RelativePathsStartAtTheFile) {
    const Result<Config> config =
        load("[paths]\ndrop = \"in/\"\nstate = \"./state\"\ncache = \"../cache\"\n");
    ASSERT_TRUE(config) << config.error().message;
    const auto here = std::filesystem::canonical(directory_.path());
    EXPECT_EQ(config->fixed.paths.drop, here / "in");
    EXPECT_EQ(config->fixed.paths.state, here / "state");
    EXPECT_EQ(config->fixed.paths.cache, here.parent_path() / "cache");
}

TEST_F(ConfigFile, LevelsAsBottomTopStepReachTheTop) {
    const Result<Config> config =
        load(std::string(paths) + "[ingest]\nlevels_km = \"0.1:0.5:0.1\"\n");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->fixed.grid.levels_m, (std::vector<double>{100, 200, 300, 400, 500}));
}

TEST_F(ConfigFile, ErrorsNameFileLineAndKey) {
    const std::string p = paths;  // four lines
    EXPECT_EQ(complaint(p + "[ingest]\nworker = 2\n"), "s.toml:6: unknown key [ingest] worker");
    EXPECT_EQ(complaint(p + "[ingets]\nworkers = 2\n"), "s.toml:5: unknown section [ingets]");
    EXPECT_EQ(complaint("workers = 2\n" + p), "s.toml:1: unknown key workers");
    EXPECT_EQ(complaint("log = 2\n" + p), "s.toml:1: log: must be a section: [log], is a number");
    EXPECT_EQ(complaint(p + "[ingest]\n\nworkers = \"2\"\n"),
              "s.toml:7: [ingest] workers: must be a whole number, is text");
    EXPECT_EQ(complaint(p + "[ingest]\nworkers = 2.5\n"),
              "s.toml:6: [ingest] workers: must be a whole number, is a number");
    EXPECT_EQ(complaint(p + "[ingest]\nworkers = -1\n"),
              "s.toml:6: [ingest] workers: -1 is out of range, must be 0 to 256");
    EXPECT_EQ(complaint(p + "[ingest]\nquiet_seconds = nan\n"),
              "s.toml:6: [ingest] quiet_seconds: nan is out of range, must be 1 to 86400");
    EXPECT_EQ(complaint(p + "[ingest]\nquiet_seconds = true\n"),
              "s.toml:6: [ingest] quiet_seconds: must be a number, is true or false");
    EXPECT_EQ(
        complaint(p + "[ingest]\nmoment = \"REFL\"\n"),
        "s.toml:6: [ingest] moment: \"REFL\" is not a moment: give one of REF VEL SW ZDR PHI RHO "
        "CFP VELD SRV AZSH DIVG POW KDP RATE HCA");
    EXPECT_EQ(complaint(p + "[ingest]\nextent_km = [1, 2, 3]\n"),
              "s.toml:6: [ingest] extent_km: must be [width, height]");
    EXPECT_EQ(complaint(p + "[ingest]\nextent_km = [460, 460.5]\n"),
              "s.toml:6: [ingest] extent_km: 460.5 km is not 1 to 16384 cells of 1 km");
    EXPECT_EQ(complaint(p + "[ingest]\nlevels_km = \"16:0.5:1\"\n"),
              "s.toml:6: [ingest] levels_km: \"16:0.5:1\" is not BOTTOM:TOP:STEP, as in "
              "\"0.5:16:0.5\"");
    EXPECT_EQ(complaint(p + "[ingest]\nlevels_km = []\n"),
              "s.toml:6: [ingest] levels_km: must name at least one level");
    EXPECT_EQ(complaint(p + "[ingest]\nlevels_km = [1, \"2\"]\n"),
              "s.toml:6: [ingest] levels_km: must be an array of numbers, holds text");
    EXPECT_EQ(complaint(p + "[log]\nlevel = \"loud\"\n"),
              "s.toml:6: [log] level: \"loud\" must be one of debug, info, warning, error");
}

// The configuration rejects the levels that the grid library rejects, and names the line.
TEST_F(ConfigFile, LevelsThatDoNotRiseAreRefused) {
    EXPECT_TRUE(complaint(std::string(paths) + "[ingest]\nlevels_km = [2, 1]\n")
                    .starts_with("s.toml:6: [ingest] levels_km: "));
    EXPECT_TRUE(complaint(std::string(paths) + "[ingest]\nlevels_km = \"0:100:10\"\n")
                    .starts_with("s.toml:6: [ingest] levels_km: "));
}

TEST_F(ConfigFile, TheEarliestLineIsNamed) {
    EXPECT_EQ(complaint(std::string(paths) + "[log]\nlevel = 1\n[ingest]\nworkers = 999\n"),
              "s.toml:6: [log] level: must be text in quotes, is a number");
}

TEST_F(ConfigFile, BrokenTomlNamesTheLine) {
    EXPECT_TRUE(complaint("[paths]\ndrop = \n").starts_with("s.toml:2: not valid TOML: "));
    EXPECT_TRUE(
        complaint("[paths]\ndrop = \"/a\"\ndrop = \"/b\"\n").starts_with("s.toml:3: not valid"));
}

TEST_F(ConfigFile, DropMustBeNamed) {
    EXPECT_EQ(complaint(""), "s.toml: [paths] drop: must be given; it is the drop directory");
    EXPECT_EQ(complaint("\n[paths]\nstate = \"/s\"\n"),
              "s.toml:2: [paths] drop: must be given; it is the drop directory");
    EXPECT_EQ(complaint("[paths]\ndrop = \"\"\n").substr(0, 10), "s.toml:2: ");
}

TEST_F(ConfigFile, PathsWithinOneAnotherAreRefused) {
    EXPECT_EQ(complaint("[paths]\ndrop = \"/d\"\nstate = \"/s\"\ncache = \"/d/cache\"\n"),
              "s.toml:4: [paths] cache: /d/cache is the same as or within /d (drop); the three "
              "directories must be separate");
    EXPECT_EQ(complaint("[paths]\ndrop = \"/s/in\"\nstate = \"/s/\"\ncache = \"/c\"\n"),
              "s.toml:2: [paths] drop: /s/in is the same as or within /s (state); the three "
              "directories must be separate");
    EXPECT_EQ(complaint("[paths]\ndrop = \"/d\"\nstate = \"/x\"\ncache = \"/x\"\n").substr(0, 9),
              "s.toml:3:");
    // The text of a path may begin with the text of another path although neither directory is
    // within the other.
    EXPECT_EQ(complaint("[paths]\ndrop = \"/d\"\nstate = \"/d2\"\ncache = \"/d3\"\n"),
              "no complaint");
}

TEST_F(ConfigFile, DirectoriesOfMachinesHaveNamesAndAreApart) {
    const auto load_with = [&](const std::string& directories) {
        return load(std::string(paths) + "[partials]\nlate_after_seconds = 300\ndirectories = [" +
                    directories + "]\n");
    };
    const auto two = load_with("\"/p/north\", \"/p/south-2/\"");
    ASSERT_TRUE(two) << two.error().message;
    EXPECT_EQ(two->fixed.partials.directories,
              (std::vector<std::filesystem::path>{"/p/north", "/p/south-2"}));
    EXPECT_EQ(two->fixed.partials.late_after, std::chrono::seconds{300});
    for (const char* wrong : {"\"\"", "\"/c/north\"", "\"/d\"", "\"/\"", "\"/p/a b\"",
                              "\"/p/a\", \"/p/a/b\"", "\"/p/a\", \"/q/a\"", "\"/p/a\", \"/p/a\""})
        EXPECT_FALSE(load_with(wrong)) << wrong;
    EXPECT_THAT(load_with("\"/p/a\", \"/q/a\"").error().message,
                ::testing::HasSubstr("[partials] directories: two machines have the name a"));
}

TEST_F(ConfigFile, StationsOfMachinesComeFromThemAlone) {
    const auto load_with = [&](const std::string& stations) {
        return load(std::string(paths) + "[partials]\ndirectories = [\"/p/a\", \"/p/b\"]\n" +
                    "[partials.stations]\n" + stations);
    };
    const auto one = load_with("a = [\"KBGM\", \"KENX\"]\n");
    ASSERT_TRUE(one) << one.error().message;
    const PartialsConfig& partials = one->fixed.partials;
    EXPECT_TRUE(partials.may_bring("a", "KBGM"));
    EXPECT_FALSE(partials.may_bring("a", "KOKX"));
    EXPECT_FALSE(partials.may_bring("b", "KBGM"));
    EXPECT_TRUE(partials.may_bring("b", "KOKX"));
    EXPECT_TRUE(PartialsConfig{}.may_bring("b", "KBGM"));
    for (const char* wrong : {"a = [\"nowhere\"]\n", "c = [\"KBGM\"]\n", "a = \"KBGM\"\n"})
        EXPECT_FALSE(load_with(wrong)) << wrong;
}

TEST_F(ConfigFile, ALinkDoesNotHideThatPathsAreTheSame) {
    std::filesystem::create_directory(directory_ / "real");
    std::filesystem::create_symlink(directory_ / "real", directory_ / "link");
    EXPECT_EQ(complaint("[paths]\ndrop = \"real\"\nstate = \"s\"\ncache = \"link/cache\"\n")
                  .substr(0, 25),
              "s.toml:4: [paths] cache: ");
}

TEST_F(ConfigFile, MissingOrOddFilesAreClear) {
    const Result<Config> missing = load_config(directory_ / "none.toml");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::not_found);
    EXPECT_NE(missing.error().message.find("none.toml"), std::string::npos);
    const Result<Config> directory = load_config(directory_.path());
    ASSERT_FALSE(directory);
    EXPECT_EQ(directory.error().code, ErrorCode::not_a_file);
}

TEST_F(ConfigFile, LoopsAreTaken) {
    const Result<Config> config =
        load(std::string(paths) +
             "[[loop]]\nname = \"ktlx\"\nscene = \"scenes/a.toml\"\ndomain = \"KTLX\"\n"
             "last = 24\noutputs = [\"/srv/a.webp\", \"frames/\"]\n"
             "[[loop]]\nname = \"all-of_it\"\nscene = \"/b.toml\"\nhours = 1.5\n");
    ASSERT_TRUE(config) << config.error().message;
    ASSERT_EQ(config->reloadable.loops.size(), 2U);
    const std::filesystem::path directory = std::filesystem::absolute(directory_.path());
    const LoopConfig& first = config->reloadable.loops[0];
    EXPECT_EQ(first.name, "ktlx");
    EXPECT_EQ(first.scene, directory / "scenes/a.toml");
    EXPECT_EQ(first.domain, "KTLX");
    EXPECT_EQ(first.last, 24);
    EXPECT_EQ(first.seconds, 0);
    EXPECT_EQ(first.outputs,
              (std::vector<std::string>{"/srv/a.webp", (directory / "frames/").native()}));
    EXPECT_EQ(config->reloadable.loops[1].scene, "/b.toml");
    EXPECT_EQ(config->reloadable.loops[1].domain, "");
    EXPECT_EQ(config->reloadable.loops[1].seconds, 5400);
    EXPECT_TRUE(config->reloadable.loops[1].outputs.empty());
}

TEST_F(ConfigFile, ScenesThatAreNotThereAreRefusedWhereTheyMustBe) {
    write_file(directory_ / "a.toml", "");
    const auto must_be = [&](const std::string& scene) -> std::string {
        const std::string text =
            std::string(paths) + "[[loop]]\nname = \"a\"\nscene = \"" + scene + "\"\n";
        EXPECT_TRUE(load(text)) << "a running service accepts a missing scene";
        const Result<Config> config = load_config(file(), SceneFiles::must_exist);
        return config ? "" : config.error().message;
    };
    const std::string directory = std::filesystem::absolute(directory_.path()).native() + "/";
    EXPECT_EQ(must_be("a.toml"), "");
    EXPECT_EQ(must_be("none.toml"), file().native() + ":7: [loop] scene: " + directory +
                                        "none.toml: No such file or directory");
    EXPECT_EQ(must_be("."), file().native() + ":7: [loop] scene: " + directory + ": is not a file");
}

TEST_F(ConfigFile, TheStatusIsAskedForWhereItIsSaid) {
    const auto config =
        load(std::string(paths) + "[status]\nsocket = \"run/s.sock\"\nhttp_port = 9123\n");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->fixed.status.socket,
              std::filesystem::weakly_canonical(directory_.path()) / "run/s.sock");
    EXPECT_EQ(config->fixed.status.http_port, 9123);
    const auto status = [&](const std::string& line) {
        return complaint(std::string(paths) + "[status]\n" + line + "\n");
    };
    EXPECT_EQ(status("socket = \"\""), "s.toml:6: [status] socket: must not be empty");
    EXPECT_EQ(status("socket = \"/d/s\""), "s.toml:6: [status] socket: /d/s is within /d");
    EXPECT_EQ(status("socket = \"/c/x/s\""), "s.toml:6: [status] socket: /c/x/s is within /c");
    EXPECT_EQ(status("socket = \"/s/s\""), "no complaint")
        << "a socket may be in the state directory";
    EXPECT_EQ(status("socket = \"/" + std::string(107, 'x') + "\""),
              "s.toml:6: [status] socket: has more than 107 bytes");
    EXPECT_EQ(status("http_port = 65536"),
              "s.toml:6: [status] http_port: 65536 is out of range, must be 0 to 65535");
    EXPECT_EQ(status("port = 1"), "s.toml:6: unknown key [status] port");
}

TEST(DefaultSocket, LiesInTheRuntimeDirectoryOrWithTheState) {
    EXPECT_EQ(default_socket("/s", nullptr), "/s/status.sock");
    EXPECT_EQ(default_socket("/s", ""), "/s/status.sock");
    EXPECT_EQ(default_socket("/s", "/run/stormcellar"), "/run/stormcellar/status.sock");
    EXPECT_EQ(default_socket("/s", "/run/a:/run/b"), "/run/a/status.sock");
}

TEST_F(ConfigFile, LoopsThatMakeNoSenseAreRefused) {
    const auto loop = [&](const std::string& lines) {
        return complaint(std::string(paths) + "[[loop]]\n" + lines);
    };
    EXPECT_EQ(loop("scene = \"a.toml\"\n"), "s.toml:5: [loop] name: must be given");
    EXPECT_EQ(loop("name = \"a/b\"\nscene = \"a.toml\"\n"),
              "s.toml:6: [loop] name: \"a/b\" must consist of letters, digits, - and _");
    EXPECT_EQ(loop("name = \"a\"\nscene = \"a.toml\"\n[[loop]]\nname = \"a\"\nscene = \"b\"\n"),
              "s.toml:9: [loop] name: \"a\" is named twice");
    EXPECT_EQ(loop("name = \"a\"\ndomain = \"KTLX\"\n"),
              "s.toml:5: [loop] outputs: must be given if no scene is named");
    EXPECT_EQ(loop("name = \"a\"\noutputs = [\"a.webp\"]\n"),
              "s.toml:5: [loop] domain: must be given if no scene is named");
    EXPECT_EQ(loop("name = \"a\"\nscene = \"\"\n"), "s.toml:7: [loop] scene: must not be empty");
    EXPECT_EQ(loop("name = \"a\"\nscene = \"b\"\ndomain = \"../x\"\n"),
              "s.toml:8: [loop] domain: \"../x\" is not a valid name of a domain");
    EXPECT_EQ(loop("name = \"a\"\nscene = \"b\"\nlast = 0\n"),
              "s.toml:8: [loop] last: 0 is out of range, must be 1 to 1000000");
    EXPECT_EQ(loop("name = \"a\"\nscene = \"b\"\nhours = 0\n").substr(0, 23),
              "s.toml:8: [loop] hours:");
    EXPECT_EQ(loop("name = \"a\"\nscene = \"b\"\noutputs = []\n"),
              "s.toml:8: [loop] outputs: must name at least one");
    EXPECT_EQ(loop("name = \"a\"\nscene = \"b\"\noutputs = \"a.webp\"\n"),
              "s.toml:8: [loop] outputs: must be an array of texts, is text");
    EXPECT_EQ(loop("name = \"a\"\nscene = \"b\"\noutputs = [\"/d/x/a.webp\"]\n"),
              "s.toml:8: [loop] outputs: /d/x/a.webp is within /d");
    EXPECT_EQ(loop("name = \"a\"\nscene = \"b\"\noutputs = [\"/o/f\", \"/o/f/\"]\n"),
              "s.toml:8: [loop] outputs: /o/f/ is named twice");
    EXPECT_EQ(loop("name = \"a\"\nscene = \"b\"\nfps = 8\n"), "s.toml:8: unknown key [loop] fps");
    EXPECT_EQ(loop("nam = \"a\"\nscene = \"b\"\n"), "s.toml:6: unknown key [loop] nam");
    EXPECT_EQ(complaint(std::string(paths) + "[loop]\nname = \"a\"\n"),
              "s.toml:5: loop: must be sections: [[loop]], is a table");
}

}  // namespace
}  // namespace stormcellar::daemon
