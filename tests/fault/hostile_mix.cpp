#include "tests/fault/hostile_mix.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "stormcellar/base/station_table.h"
#include "tests/fault/hostile_feed.h"
#include "tests/testing/waiting.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
namespace wire = level2::wire;
using Clock = std::chrono::steady_clock;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

struct Share {
    Attack attack;
    std::string_view name;
    unsigned in_ten_thousand;
};

// Shares of 10,000 files; the rest are volumes of invented stations. Attacks that cost the daemon a
// second of processor time each, such as a bomb, are rare, because they also cost their sender
// much.
constexpr std::array<Share, attack_count> shares = {{
    {Attack::invented, "invented", 3000},
    {Attack::known, "known", 300},
    {Attack::endless, "endless", 20},
    {Attack::growth, "growth", 500},
    {Attack::unsettled, "unsettled", 1000},
    {Attack::chunk, "chunks", 1500},
    {Attack::rename, "renames", 800},
    {Attack::link, "links", 600},
    {Attack::special, "FIFOs", 300},
    {Attack::sparse, "sparse", 150},
    {Attack::name, "names", 800},
    {Attack::clock, "clocks", 325},
    {Attack::bomb, "bombs", 5},
    {Attack::deleted, "deleted", 700},
}};

constexpr std::size_t invented_count = 2000, volumes_at_once = 600, most_growing = 100;
constexpr int directory_count = 64, chunks_of_a_volume = 60;

Claims small_claims(Claims claims) {
    claims.radials = 4;
    claims.gates = 20;
    return claims;
}

// Returns `records` compressed records of some 90 bytes; each unpacks to 45 MB.
Bytes bomb_bytes(unsigned records) {
    static const Bytes stream = wire::bzip2(Bytes(45'000'000));
    const Bytes record =
        wire::Writer{}.u32(static_cast<std::uint32_t>(stream.size())).raw(stream).bytes;
    Claims claims = small_claims(claims_of("KTLX", now_utc() - hours{3}));
    Bytes all = wire::join({file_header(claims), wire::ldm_record(sweep_messages(claims, 1))});
    for (unsigned i = 0; i < records; ++i)
        all.insert(all.end(), record.begin(), record.end());
    return all;
}

// Returns a time that no real volume of the feed has: hours before the feed.
UtcTime some_time(std::size_t number) {
    return now_utc() - hours{2} - milliseconds{static_cast<std::int64_t>(number) * 3001};
}

void make_socket(const fs::path& path) {
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    if (path.native().size() >= sizeof address.sun_path) return;
    const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    path.native().copy(address.sun_path, sizeof address.sun_path - 1);
    if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        std::printf("no socket at %s\n", path.c_str());
    ::close(socket);
}

void append_bytes(const fs::path& path, const Bytes& bytes) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file < 0) return;  // an attack has just renamed its directory
    if (::write(file, bytes.data(), bytes.size()) < 0)
        std::printf("%s: not written\n", path.c_str());
    ::close(file);
}

void set_size(const fs::path& path, off_t size) {
    if (::truncate(path.c_str(), size) != 0) std::printf("%s: has no hole\n", path.c_str());
}

void set_modified(const fs::path& path, std::int64_t second) {
    const std::array<timespec, 2> times = {timespec{second, 0}, timespec{second, 0}};
    ::utimensat(AT_FDCWD, path.c_str(), times.data(), AT_SYMLINK_NOFOLLOW);
}

void remove_path(const fs::path& path) {
    std::error_code ignored;
    fs::remove_all(path, ignored);
}

// Returns a hostile name. It depends on `number`, so that few names repeat.
std::string evil_name(std::uint64_t number, const std::string& station) {
    const std::string n = std::to_string(number);
    switch (number % 12) {
        case 0:
            return station + "_" + n + "\n2026-11-22T00:00:00.000Z error: forged";
        case 1:
            return station + "_" + n + "\r\x1b[2J\x1b]0;title\x07";
        case 2:
            return station + "_" + n + "\xff\xfe\xc0\xaf";
        case 3:
            return station + "_" + n + "\",\"reason\":\"x\"}],\"forged\":true,\"y\":[{\"z\":\"";
        case 4:
            return "-rf" + n;
        case 5:
            return station + "_{}%s%n$(id)`id`" + n;
        case 6:
            return station + "_\xe2\x80\xae" + n + std::string(200, 'x');
        case 7:
            return n + std::string(255 - n.size(), 'y');
        case 8:
            return station + "20241003_010000_V06." + n;
        case 9:
            return "20241003-010000-" + n + "-S";
        case 10:
            return "20241003-010000-001-" + n;
        default:
            return station + " " + n + "\xc2\x9b\x31\x6d\xe2\x80\x8b\xef\xbb\xbf";
    }
}

}  // namespace

std::string_view name_of(Attack attack) {
    return shares[static_cast<std::size_t>(attack)].name;
}

HostileMix::HostileMix(MixOptions options) : options_(std::move(options)), random_(options_.seed) {
    for (const Station& station : all_stations())
        known_names_.emplace_back(station.icao);
    make_bytes();
    for (int i = 0; i < directory_count; ++i) {
        directories_.push_back(options_.drop / "h" / std::to_string(i));
        fs::create_directories(directories_.back());
    }
    for (std::size_t i = 0; i < volumes_at_once; ++i)
        volumes_.push_back({{}, {}, i % known_names_.size(), chunks_of_a_volume + 1});
}

HostileMix::~HostileMix() {
    if (thread_.joinable()) end();
}

void HostileMix::make_bytes() {
    for (std::size_t i = 0; i < invented_count; ++i) {
        Claims claims = small_claims(invented_claims(i, some_time(i)));
        if (i % 2 == 0) claims.latitude_deg = claims.longitude_deg = 0;
        if (i % 10 == 1) claims.radials = 360;
        invented_.push_back(i % 3 == 0 ? plain_volume_bytes(claims) : volume_bytes(claims));
    }
    for (std::size_t i = 0; i < known_names_.size(); ++i) {
        const Claims claims = claims_of(known_names_[i], some_time(i));
        known_.push_back({volume_bytes(small_claims(claims)), overflowing_bytes(claims)});
        headers_.push_back(file_header(claims));
        Claims piece = small_claims(claims);
        piece.radials = 30;
        records_.push_back(
            wire::ldm_record(sweep_messages(piece, static_cast<unsigned>(1 + i % 3)), false, 1));
        Claims wrong = small_claims(claims);
        wrong.time = i % 2 == 0 ? NexradTime{0, 3'600'000} : NexradTime{29'220, 3'600'000};
        if (i % 4 < 2) wrong.station = invented_station(i);
        clocks_.push_back(volume_bytes(wrong));
    }
    for (std::size_t i = 0; i < 24; ++i) {
        const Claims claims =
            i % 3 == 0 ? invented_claims(i, some_time(i))
                       : claims_of(known_names_[i * 7 % known_names_.size()], some_time(i));
        endless_small_.push_back(
            wire::join({endless_bytes(claims, 250, 10'000), begun_record(500'000)}));
        if (i < 12)
            endless_large_.push_back(wire::join({endless_bytes(claims), begun_record(30'000'000)}));
        unsettled_.push_back(overflowing_bytes(claims));
        Claims open = small_claims(claims);
        open.sweeps = 2;
        unsettled_.push_back(
            wire::join({file_header(open), wire::ldm_record(sweep_messages(open, 0))}));
        unsettled_.push_back(file_header(claims));
    }
    unsettled_.emplace_back();
    unsettled_.emplace_back(300, std::byte{'x'});
    bombs_.push_back(bomb_bytes(700));
    small_bombs_.push_back(bomb_bytes(1));
}

// Places the file in a directory of a real station, in the drop directory itself, or deeper.
HostileMix::Standing HostileMix::place(std::string_view stem) {
    const std::string name = fmt::format("{}_{}", stem, ++number_);
    switch (below(8)) {
        case 0: {
            const fs::path directory = options_.drop / real_stations()[below(16)];
            std::error_code ignored;
            fs::create_directory(directory, ignored);
            return {directory / name, {}};
        }
        case 1:
            return {options_.drop / name, {}};
        default:
            return {name, below(directories_.size())};
    }
}

fs::path HostileMix::path_of(const Standing& file) const {
    return file.directory ? directories_[*file.directory] / file.path : file.path;
}

// Returns a known or an invented station with equal probability.
std::string HostileMix::some_station() {
    return below(2) == 0 ? known_names_[below(known_names_.size())]
                         : invented_station(below(invented_count));
}

// Writes the file under its own name, or under a dot-name and then renames it.
void HostileMix::write(const Standing& file, const Bytes& bytes) {
    const fs::path path = path_of(file);
    if (below(2) == 0) {
        append_bytes(path, bytes);
    } else {
        const fs::path hidden = path.parent_path() / fmt::format(".{}", number_);
        append_bytes(hidden, bytes);
        std::rename(hidden.c_str(), path.c_str());
    }
    standing_.push_back(file);
}

void HostileMix::strike_known() {
    const bool is_real = below(10) == 0;
    std::size_t station = below(known_names_.size());
    if (is_real) {
        const auto at = std::find(known_names_.begin(), known_names_.end(),
                                  real_stations()[below(real_stations().size())]);
        station = static_cast<std::size_t>(at - known_names_.begin());
    }
    const std::string stem = known_names_[station] + format_compact(some_time(number_ % 900));
    write(place(stem), one_of(known_[station]));
}

void HostileMix::strike_endless() {
    if (growing_.size() >= most_growing) {
        const std::size_t index = below(growing_.size());
        remove_path(path_of(growing_[index]));
        growing_.erase(growing_.begin() + static_cast<std::ptrdiff_t>(index));
    }
    const bool is_large = below(4) == 0;
    growing_.push_back(place(some_station()));
    const fs::path path = path_of(growing_.back());
    append_bytes(path, one_of(is_large ? endless_large_ : endless_small_));
    // Leave a hole in place of a record that has not ended.
    if (is_large && below(2) == 0) set_size(path, 25'000'000);
}

void HostileMix::strike_growth() {
    if (growing_.empty()) return strike_endless();
    append_bytes(path_of(growing_[below(growing_.size())]), Bytes(1 + below(20), std::byte{'g'}));
}

void HostileMix::strike_unsettled() {
    write(place(some_station() + "_unsettled"), one_of(unsettled_));
}

void HostileMix::strike_chunk() {
    Volume& volume = volumes_[number_ % volumes_.size()];
    ++number_;
    if (volume.next > chunks_of_a_volume) {
        if (!volume.directory.empty()) standing_.push_back({volume.directory, {}});
        volume.station = below(known_names_.size());
        const bool is_invented = below(2) == 0;
        const std::string station =
            is_invented ? invented_station(below(invented_count)) : known_names_[volume.station];
        // The real feed numbers its directories from 1 to 999.
        volume.directory = options_.drop / station / std::to_string(100'000 + number_);
        const std::string time = format_compact(some_time(below(5000)));
        volume.name = time.substr(0, 8) + "-" + time.substr(9);
        volume.next = 1 + static_cast<int>(below(3));  // some volumes lack their start
        std::error_code ignored;
        fs::create_directories(volume.directory, ignored);
    }
    const int chunk = volume.next++;
    const fs::path path =
        volume.directory / fmt::format("{}-{:03}-{}", volume.name, chunk, chunk == 1 ? 'S' : 'I');
    if (chunk == 1) append_bytes(path, headers_[volume.station]);
    append_bytes(path, records_[volume.station]);
}

// Renames a directory with everything in it and renames it back, or gives a file another name.
void HostileMix::strike_rename() {
    if (below(8) == 0) {
        fs::path& directory = directories_[below(directories_.size())];
        fs::path other = directory.parent_path() / fmt::format("away{}", ++number_);
        if (std::rename(directory.c_str(), other.c_str()) != 0) return;
        if (below(2) == 0)
            std::rename(other.c_str(), directory.c_str());
        else
            directory = other;
        return;
    }
    if (standing_.empty()) return strike_unsettled();
    Standing& file = standing_[below(standing_.size())];
    const Standing other = place("renamed");
    if (std::rename(path_of(file).c_str(), path_of(other).c_str()) == 0) file = other;
}

void HostileMix::strike_link() {
    const Standing file = place(some_station() + "_link");
    const fs::path path = path_of(file);
    const std::array<fs::path, 7> targets = {options_.outside / "KTLX_volume",
                                             options_.outside,
                                             options_.outside / "none",
                                             path.filename(),
                                             fs::path{".."},
                                             "/proc/self/mem",
                                             "/etc/passwd"};
    if (::symlink(targets[below(targets.size())].c_str(), path.c_str()) == 0)
        standing_.push_back(file);
}

void HostileMix::strike_special() {
    const Standing file = place("f");
    const fs::path path = path_of(file);
    if (below(2) == 0)
        make_socket(path);
    else if (::mkfifo(path.c_str(), 0666) != 0)
        return;
    standing_.push_back(file);
}

void HostileMix::strike_sparse() {
    standing_.push_back(place(some_station() + "_sparse"));
    const fs::path path = path_of(standing_.back());
    append_bytes(path, one_of(unsettled_));
    // One file in twenty is within the allowed size of a raw file, so the daemon reads it.
    const off_t size = below(20) == 0 ? off_t{200} << 20 : off_t{1} << (32 + below(9));
    set_size(path, size);
}

void HostileMix::strike_name() {
    const std::string station = some_station();
    Standing file = place("x");
    file.path.replace_filename(fs::path{evil_name(number_, station)});
    write(file, one_of(below(2) == 0 ? unsettled_ : invented_));
}

void HostileMix::strike_clock() {
    write(place(some_station() + "_clock"), one_of(clocks_));
    const fs::path path = path_of(standing_.back());
    constexpr std::array<std::int64_t, 4> times = {1, 4'000'000'000, 253'402'300'799, -86'400};
    set_modified(path, times[below(times.size())]);
}

void HostileMix::strike_deleted() {
    const fs::path path = path_of(place(some_station() + "_deleted"));
    append_bytes(path, one_of(invented_));
    ::unlink(path.c_str());
}

void HostileMix::strike(Attack attack) {
    ++done_[static_cast<std::size_t>(attack)];
    switch (attack) {
        case Attack::invented: {
            const std::size_t which = below(invented_.size());
            write(place(invented_station(which) + "20241003_010000"), invented_[which]);
            return;
        }
        case Attack::known:
            return strike_known();
        case Attack::endless:
            return strike_endless();
        case Attack::growth:
            return strike_growth();
        case Attack::unsettled:
            return strike_unsettled();
        case Attack::chunk:
            return strike_chunk();
        case Attack::rename:
            return strike_rename();
        case Attack::link:
            return strike_link();
        case Attack::special:
            return strike_special();
        case Attack::sparse:
            return strike_sparse();
        case Attack::name:
            return strike_name();
        case Attack::clock:
            return strike_clock();
        case Attack::bomb:
            write(place(some_station() + "_bomb"),
                  below(10) == 0 ? bombs_.front() : small_bombs_.front());
            return;
        case Attack::deleted:
            return strike_deleted();
    }
}

void HostileMix::strike() {
    std::size_t at = below(10'000);
    for (const Share& share : shares) {
        if (at < share.in_ten_thousand) return strike(share.attack);
        at -= share.in_ten_thousand;
    }
    strike(Attack::invented);
}

void HostileMix::make_room() {
    while (standing_.size() > options_.most_standing) {
        remove_path(path_of(standing_.front()));
        standing_.pop_front();
    }
}

void HostileMix::run() {
    const auto begin = Clock::now();
    double done = 0;
    while (!stopping_) {
        seconds_ = std::chrono::duration<double>(Clock::now() - begin).count();
        for (; done < seconds_ * options_.rate && !stopping_; ++done)
            strike();
        make_room();
        testing::pass_time(milliseconds{5});
    }
}

void HostileMix::begin() {
    thread_ = std::thread([this] { run(); });
}

void HostileMix::end() {
    stopping_ = true;
    thread_.join();
}

// Removes everything but the real volumes, which are in the directories of the stations.
void HostileMix::remove_all() {
    for (const Standing& file : standing_)
        remove_path(path_of(file));
    for (const Standing& file : growing_)
        remove_path(path_of(file));
    for (const Volume& volume : volumes_)
        remove_path(volume.directory);
    remove_path(options_.drop / "h");
    standing_.clear();
    growing_.clear();
}

std::uint64_t HostileMix::all_done() const {
    return std::accumulate(done_.begin(), done_.end(), std::uint64_t{0});
}

}  // namespace stormcellar::fault
