#include "tests/fault/load.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/encode.h"
#include "synth/replay_pieces.h"
#include "tests/fault/feed_volume.h"
#include "tests/testing/data.h"
#include "tests/testing/waiting.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;

constexpr int gates = 160;  // number of gates, each 250 m long
const std::vector<std::string> usual_stations = {"XFAA", "XFAB", "XFAC", "XFAD", "XFAE", "XFAF"};
constexpr double latitude_deg = 35;
constexpr double first_longitude_deg = -98;  // each further station is a degree farther east
constexpr double antenna_altitude_m = 380;

level2::Volume pattern_of(const std::string& station, double longitude_deg) {
    const FeedScene scene{station,
                          latitude_deg,
                          longitude_deg,
                          antenna_altitude_m,
                          {0.5, 4},
                          false,
                          {{12, 9, 9, 6, 40, 2, 9, 55}}};
    return observed_volume(text_of(scene), gates);
}

void move_to(level2::Volume& volume, UtcTime start) {
    const auto by = start - volume.header->time();
    const NexradTime time = nexrad_from_time(start);
    volume.header->date = time.day;
    volume.header->ms = time.milliseconds;
    for (level2::Sweep& sweep : volume.sweeps) {
        for (level2::Radial& radial : sweep.radials)
            radial.time += by;
    }
}

void expect(const Status& done) {
    if (!done) throw std::runtime_error(done.error().message);
}

// Writes a file as a script does: under a dot-name, then renames it.
void put_whole(const Shipment& shipment) {
    const fs::path& file = shipment.delivered.files.front();
    const fs::path hidden = file.parent_path() / ("." + file.filename().native());
    synth::PieceWriter writer(0);
    for (const auto& piece : shipment.pieces)
        expect(writer.append(hidden, piece));
    fs::rename(hidden, file);
}

}  // namespace

std::string usual_station_tables() {
    std::string tables;
    double longitude_deg = first_longitude_deg;
    for (const std::string& station : usual_stations) {
        tables += fmt::format(
            "[[station]]\nicao = \"{}\"\nlatitude_deg = {}\nlongitude_deg = {}\n"
            "antenna_altitude_m = {}\n",
            station, latitude_deg, longitude_deg++, antenna_altitude_m);
    }
    return tables;
}

Shipments::Shipments(fs::path drop, std::uint32_t seed, const std::vector<std::string>& stations)
    : drop_(std::move(drop)), random_(seed) {
    double longitude_deg = first_longitude_deg;
    for (const std::string& station : stations.empty() ? usual_stations : stations)
        patterns_.push_back(pattern_of(station, longitude_deg++));
    if (!stations.empty()) return;
    const auto data = testing::data_directory();
    if (!data) return;
    std::vector<fs::path> sources = {*data / "volumes/Level2_TSTL_20220213_2357.ar2v",
                                     *data / "volumes/KTLX20170101_030027_V06"};
    for (const auto& entry : fs::directory_iterator(*data / "sequence-kbgm"))
        sources.push_back(entry.path());
    for (const fs::path& source : sources) {
        auto bytes = read_file(source);
        const auto decoded = bytes ? level2::decode(*bytes) : tl::unexpected(bytes.error());
        if (!decoded) throw std::runtime_error(decoded.error().message);
        real_.push_back(
            {source, decoded->volume.station, *decoded->volume.start_time(), std::move(*bytes)});
    }
}

Shipment Shipments::laid_out(Way way, const std::string& station, UtcTime start,
                             std::vector<std::vector<std::byte>> pieces) {
    Shipment shipment{way, std::move(pieces), {{}, Contents::whole_volume, station, start}};
    if (way != Way::chunks) {
        shipment.delivered.files = {drop_ / station / (station + format_compact(start) + "_V06")};
        return shipment;
    }
    for (const std::string& name : chunk_names(start, shipment.pieces.size()))
        shipment.delivered.files.push_back(drop_ / station / fmt::format("{}", number_) / name);
    return shipment;
}

Shipment Shipments::volume(Way way) {
    const auto index = static_cast<std::size_t>(number_) % patterns_.size();
    level2::Volume& pattern = patterns_[index];
    const UtcTime start = UtcTime{std::chrono::seconds{1717200000}} +
                          std::chrono::seconds{60 * (number_ / static_cast<int>(patterns_.size()))};
    ++number_;
    move_to(pattern, start);
    const auto encoded = level2::encode(pattern);
    if (!encoded) throw std::runtime_error(encoded.error().message);
    return laid_out(way, pattern.station, start, pieces_of(encoded->joined()));
}

// Leaves out the last pieces of a file, or a chunk in the middle.
Shipment Shipments::part(Way way) {
    Shipment shipment = volume(way);
    shipment.delivered.contents = Contents::part;
    const auto at = static_cast<std::ptrdiff_t>(3 + random_() % 3);
    if (way == Way::chunks) {
        shipment.pieces.erase(shipment.pieces.begin() + at);
        shipment.delivered.files.erase(shipment.delivered.files.begin() + at);
    } else {
        shipment.pieces.resize(static_cast<std::size_t>(at));
    }
    return shipment;
}

Shipment Shipments::junk() {
    Shipment shipment;
    shipment.pieces.emplace_back(random_() % 3000);
    for (std::byte& byte : shipment.pieces.back())
        byte = static_cast<std::byte>(random_());
    shipment.delivered.contents = Contents::junk;
    shipment.delivered.files = {drop_ / "misc" / fmt::format("junk-{}", number_++)};
    return shipment;
}

std::optional<Shipment> Shipments::real(Way way) {
    if (real_.empty()) return std::nullopt;
    const Real& real = real_[static_cast<std::size_t>(number_) % real_.size()];
    if (way == Way::chunks && synth::has_ldm_records(real.bytes)) {
        ++number_;  // every shipment has a directory with its own number
        return laid_out(way, real.station, real.time, pieces_of(real.bytes));
    }
    Shipment shipment;
    shipment.way = way == Way::chunks ? Way::growing : way;
    shipment.pieces = pieces_of(real.bytes);
    shipment.delivered = {
        {drop_ / "real" / fmt::format("{}-{}", number_++, real.source.filename().native())},
        Contents::whole_volume,
        real.station,
        real.time};
    return shipment;
}

Shipment Shipments::next() {
    const auto way = static_cast<Way>(random_() % 4);
    switch (random_() % 40) {
        case 0:
        case 1:
            // The daemon waits half a minute for a missing chunk.
            return part(way == Way::chunks && !has_patience_ ? Way::growing : way);
        case 2:
        case 3:
            return junk();
        case 4:
            if (auto shipment = real(way)) return std::move(*shipment);
            break;
        default:
            break;
    }
    return volume(way);
}

void deliver(const Shipment& shipment) {
    const auto& files = shipment.delivered.files;
    fs::create_directories(files.front().parent_path());
    if (shipment.way == Way::whole) {
        put_whole(shipment);
        return;
    }
    synth::PieceWriter writer(shipment.way == Way::open ? 1 : 0);
    for (std::size_t i = 0; i < shipment.pieces.size(); ++i)
        expect(writer.append(files[std::min(i, files.size() - 1)], shipment.pieces[i]));
    expect(writer.close());
}

Feed::Feed(Shipments shipments, std::uint32_t seed, std::chrono::microseconds pause)
    : shipments_(std::move(shipments)),
      random_(seed + 1),
      pause_(pause),
      thread_([this] { run(); }) {}

Feed::~Feed() {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
}

void Feed::write_piece(Growing& growing) {
    const Shipment& shipment = growing.shipment;
    const auto& files = shipment.delivered.files;
    if (growing.next == 0) fs::create_directories(files.front().parent_path());
    if (shipment.way == Way::whole) {
        put_whole(shipment);
        growing.next = shipment.pieces.size();
        return;
    }
    auto& writer = shipment.way == Way::open ? open_ : closing_;
    expect(writer.append(files[std::min(growing.next, files.size() - 1)],
                         shipment.pieces[growing.next]));
    ++growing.next;
}

void Feed::run() {
    while (!growing_.empty() || !stopping_) {
        const bool begin = !stopping_ && begun_ < allowed_ && growing_.size() < most_at_a_time;
        if (begin) {
            growing_.push_back({shipments_.next()});
            delivered_.push_back(growing_.back().shipment.delivered);
            ++begun_;
        }
        if (!growing_.empty()) {
            const std::size_t index = random_() % growing_.size();
            write_piece(growing_[index]);
            if (growing_[index].next >= growing_[index].shipment.pieces.size())
                growing_.erase(growing_.begin() + static_cast<std::ptrdiff_t>(index));
        }
        testing::pass_time(growing_.empty() ? std::chrono::milliseconds{2} : pause_);
    }
    expect(open_.close());
}

std::vector<Delivered> Feed::finish() {
    stopping_ = true;
    thread_.join();
    return delivered_;
}

}  // namespace stormcellar::fault
