// Tests that a reload applies each key of the configuration, or that the log names the key as one
// that needs a restart. Until 2026-11-25, a reload ignored [catalog] bytes without a word.
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/config/config.h"
#include "tests/daemon/write_file.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

enum class Counts { at_reload, at_restart };

struct Key {
    std::string name;
    std::string value, other;  // texts of two values in the file
};

struct Section {
    std::string header;
    Counts counts;
    std::vector<Key> keys;
};

// Returns every key at least once. A key that excludes another key has a table of its own.
const std::vector<Section>& all_sections() {
    using enum Counts;
    static const std::vector<Section> sections = {
        {"[paths]",
         at_restart,
         {{"drop", "'/d'", "'/other'"},
          {"state", "'/s'", "'/other'"},
          {"cache", "'/c'", "'/other'"}}},
        {"[ingest]",
         at_restart,
         {{"threads", "2", "3"},
          {"stations", "'known'", "'any'"},
          {"living", "true", "false"},
          {"chunk_timeout_seconds", "600", "601"},
          {"chunk_grace_seconds", "30", "31"},
          {"bunzip", "'fastest'", "'libbz2'"},
          {"moments", "['REF']", "['REF', 'VEL']"},
          {"dealias", "'auto'", "'region'"},
          {"quality", "0", "0.5"},
          {"spacing_km", "1.0", "2.0"},
          {"extent_km", "[460, 460]", "[460, 400]"},
          {"levels_km", "'0.5:16:0.5'", "[1, 2]"}}},
        {"[ingest]",
         at_reload,
         {{"workers", "2", "3"}, {"quiet_seconds", "30", "31"}, {"reread_seconds", "0.5", "1"}}},
        {"[[station]]",
         at_restart,
         {{"icao", "'XABC'", "'XABD'"},
          {"name", "'Here'", "'There'"},
          {"latitude_deg", "35", "36"},
          {"longitude_deg", "-97", "-98"},
          {"antenna_altitude_m", "400", "500"}}},
        {"[cache]", at_restart, {{"refill_hours", "6", "7"}, {"compression", "'none'", "'lz4'"}}},
        {"[cache]",
         at_reload,
         {{"bytes", "'20 GB'", "'30 GB'"},
          {"percent", "95", "90"},
          {"age_hours", "48", "24"},
          {"low_watermark", "0.9", "0.8"},
          {"protect_hours", "168", "24"}}},
        {"[[cache.domain]]",
         at_reload,
         {{"name", "'KTLX'", "'KOKX'"},
          {"bytes", "'2 GB'", "'3 GB'"},
          {"percent", "50", "60"},
          {"age_hours", "24", "12"}}},
        {"[[domain]]",
         at_restart,
         {{"name", "'a'", "'aa'"},
          {"center", "[42.0, -75.5]", "[43.0, -75.5]"},
          {"projection", "'lambert_conformal'", ""},
          {"parallels_deg", "[38, 46]", "[39, 46]"},
          {"spacing_km", "1.0", "2.0"},
          {"extent_km", "[1000, 1000]", "[1000, 800]"},
          {"levels_km", "'0.5:16:0.5'", "[1, 2]"},
          {"moments", "['REF']", "['VEL']"},
          {"stations", "['KBGM', 'KOKX']", "['KBGM']"},
          {"interval_seconds", "300", "600"},
          {"overlap", "'distance-weighted'", "'mean'"},
          {"overlap_km", "250", "200"},
          {"time_method", "'advected'", "'blend'"}}},
        {"[[domain]]",
         at_restart,
         {{"name", "'b'", "'bb'"},
          {"bounds", "[-80, 30, -70, 40]", "[-81, 30, -70, 40]"},
          {"spacing_deg", "0.1", "0.2"}}},
        {"[[domain]]",
         at_restart,
         {{"name", "'c'", "'cc'"},
          {"center", "[42.0, -75.5]", "[43.0, -75.5]"},
          {"projection", "'azimuthal_equidistant'", "'lambert_conformal'"},
          {"spacing_km", "1.0", "2.0"},
          {"extent_km", "[1000, 1000]", "[1000, 800]"}}},
        {"[[domain]]",
         at_restart,
         {{"name", "'d'", "'dd'"},
          {"center", "[42.0, -75.5]", "[43.0, -75.5]"},
          {"projection", "'latitude_longitude'", ""},
          {"spacing_deg", "0.1", "0.2"},
          {"extent_deg", "[8, 4]", "[8, 8]"}}},
        {"[[loop]]",
         at_reload,
         {{"name", "'oklahoma'", "'texas'"},
          {"scene", "'/a.toml'", "'/b.toml'"},
          {"domain", "'KTLX'", "'KOKX'"},
          {"last", "24", "12"},
          {"hours", "3", "2"},
          {"outputs", "['/o/a.webp']", "['/o/b.webp']"}}},
        {"[catalog]", at_restart, {{"bytes", "'16 GB'", "'8 GB'"}}},
        {"[catalog]", at_reload, {{"gone_days", "0", "7"}}},
        {"[watch]", at_restart, {{"queue_limit", "65536", "1024"}}},
        {"[watch]", at_reload, {{"rescan_seconds", "60", "30"}, {"poll_seconds", "5", "6"}}},
        {"[status]",
         at_restart,
         {{"socket", "'/run/a.sock'", "'/run/b.sock'"}, {"http_port", "0", "9123"}}},
        {"[partials]",
         at_restart,
         {{"directories", "['/p/north']", "['/p/north', '/p/south']"},
          {"late_after_seconds", "600", "300"}}},
        {"[partials.stations]", at_restart, {{"north", "['KBGM']", "['KENX']"}}},
        // The daemon only checks these keys; stormcellar-web applies them.
        {"[web]",
         at_reload,
         {{"listen", "['127.0.0.1:8090', '[::1]:8090']", "['127.0.0.1:8091']"},
          {"names", "[]", "['radar.example.org']"},
          {"public_address", "''", "'https://radar.example.org/storms'"},
          {"trusted_proxies", "[]", "['127.0.0.1']"},
          {"serve", "['volumes', 'grids']", "['grids']"},
          {"bucket", "'unidata-nexrad-level2'", "'my-bucket'"},
          {"cors", "'none'", "'*'"},
          {"embed_in", "[]", "['https://news.example.org']"},
          {"silent_seconds", "1200", "600"},
          {"freezing_levels_m", "[4200, 7300]", "[3000, 6100]"}}},
        {"[web.limits]",
         at_reload,
         {{"connections", "1024", "1023"},
          {"connections_of_an_address", "256", "16"},
          {"event_streams", "2048", "100"},
          {"event_streams_of_a_client", "64", "10"},
          {"header_bytes", "32768", "'16 KiB'"},
          {"request_seconds", "20", "21"},
          {"least_bytes_per_second", "1000", "2000"},
          {"workers", "0", "3"},
          {"renders", "1", "2"},
          {"waiting", "32", "33"},
          {"results", "10000", "1000"},
          {"kept_bytes", "'256 MB'", "'128 MB'"},
          {"kept_picture_bytes", "'64 MB'", "'32 MB'"},
          {"open_grids", "64", "32"},
          {"answer_bytes", "'256 MB'", "'128 MB'"}}},
        {"[web.thredds]", at_reload, {{"denied", "[]", "['secret']"}}},
        {"[[web.thredds.collection]]",
         at_reload,
         {{"path", "'a'", "'b'"},
          {"title", "'A'", "'B'"},
          {"variables", "['N0Q']", "['N0C']"},
          {"files", "''", "'/products'"},
          {"stations", "[]", "['KTLX']"}}},
        {"[[overlay]]",
         at_reload,
         {{"name", "'warnings'", "'alerts'"}, {"path", "'/w/warnings'", "'/w/a.geojson'"}}},
        {"[[web.thredds.station]]",
         at_reload,
         {{"id", "'KFTG'", "'KTLX'"},
          {"name", "'Denver'", "'Boulder'"},
          {"state", "'CO'", "'WY'"},
          {"latitude_deg", "39.78", "39.79"},
          {"longitude_deg", "-104.53", "-104.54"},
          {"altitude_m", "1675", "1676"}}},
        {"[log]", at_reload, {{"level", "'info'", "'debug'"}}},
    };
    return sections;
}

// Returns a file with all keys. The key `changed` has its other value.
std::string file_with(const Key* changed) {
    std::string text, header;
    for (const Section& section : all_sections()) {
        // Keys of one section may be in two tables here, but have one header in the file.
        if (section.header != header || header.starts_with("[[")) text += section.header + "\n";
        header = section.header;
        for (const Key& key : section.keys)
            text += key.name + " = " + (&key == changed ? key.other : key.value) + "\n";
    }
    return text;
}

// Returns "[section] key" for each key of the shipped file, also for keys in comments.
std::set<std::string> shipped_keys() {
    std::set<std::string> keys;
    std::ifstream file(testing::source_directory() / "daemon/stormcellard.toml");
    const std::regex header_line(R"((?:#   )?(\[+[a-z.]+\]+).*)"),
        key_line(R"((?:#   )?([a-z_]+) = .*)");
    std::string line, header;
    std::smatch found;
    while (std::getline(file, line)) {
        if (std::regex_match(line, found, header_line)) header = found[1];
        // Other programs read these tables.
        if (header.find("[pull") != std::string::npos || header == "[feed]" ||
            header.find("[notify") != std::string::npos)
            continue;
        if (std::regex_match(line, found, key_line)) keys.insert(header + " " + found[1].str());
    }
    return keys;
}

class ReloadOfAKey : public ::testing::Test {
  protected:
    Result<Config> load(const Key* changed) {
        write_file(directory_ / "s.toml", file_with(changed));
        return load_config(directory_ / "s.toml");
    }
    testing::TemporaryDirectory directory_;
};

TEST_F(ReloadOfAKey, CountsOrIsSaidToNeedARestart) {
    const Result<Config> running = load(nullptr);
    ASSERT_TRUE(running) << running.error().message;
    EXPECT_TRUE(needs_restart(running->fixed, running->fixed).empty());
    for (const Section& section : all_sections()) {
        for (const Key& key : section.keys) {
            if (key.other.empty()) continue;  // another table changes this key
            SCOPED_TRACE(section.header + " " + key.name);
            const Result<Config> fresh = load(&key);
            ASSERT_TRUE(fresh) << fresh.error().message;
            const bool counts = fresh->reloadable != running->reloadable;
            EXPECT_EQ(counts, section.counts == Counts::at_reload);
            EXPECT_EQ(needs_restart(fresh->fixed, running->fixed).size(), counts ? 0U : 1U);
        }
    }
}

TEST_F(ReloadOfAKey, IsLookedAtForEveryKeyOfTheShippedFile) {
    std::set<std::string> looked_at;
    for (const Section& section : all_sections()) {
        for (const Key& key : section.keys)
            if (!key.other.empty()) looked_at.insert(section.header + " " + key.name);
    }
    const std::set<std::string> shipped = shipped_keys();
    EXPECT_GE(shipped.size(), 50U);
    for (const std::string& key : shipped)
        EXPECT_TRUE(looked_at.contains(key)) << key << ": what does a reload do with it?";
}

}  // namespace
}  // namespace stormcellar::daemon
