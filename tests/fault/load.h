// tests/fault/load.h -- writes files into a drop directory during faults.
//
// The files are small simulated volumes (message 31, two cuts of 360 radials) of several stations,
// each with its own time. Some volumes are truncated, and some files are junk. Real volumes, if
// there are any, are written under new names. Files are written in four ways: whole by rename,
// growing and closed after each piece, growing and kept open, and as one file for each chunk.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "stormcellar/level2/volume.h"
#include "synth/replay_writer.h"
#include "tests/fault/aftermath.h"

namespace stormcellar::fault {

enum class Way { whole, growing, open, chunks };

// One file, or one volume of chunks, ready to be written.
struct Shipment {
    Way way = Way::whole;
    std::vector<std::vector<std::byte>> pieces;
    Delivered delivered;  // `files` has one file for each piece of a volume in chunks, else one
};

// Returns the [[station]] tables of the six stations of a usual load.
[[nodiscard]] std::string usual_station_tables();

class Shipments {
  public:
    // Uses six stations and real volumes, or only the given stations.
    Shipments(std::filesystem::path drop, std::uint32_t seed,
              const std::vector<std::string>& stations = {});

    // Returns the next shipment: usually a volume, sometimes a part of a volume, junk or a real
    // volume.
    Shipment next();
    // Allows shipments that lack chunks. The daemon waits for missing chunks, so a test with such
    // shipments takes longer.
    void have_patience() { has_patience_ = true; }
    Shipment volume(Way way);
    Shipment junk();
    Shipment part(Way way);
    // Returns a real volume; none if there are no data. If chunks are requested but the volume has
    // no LDM records, it comes as a growing file.
    std::optional<Shipment> real(Way way);

  private:
    struct Real {
        std::filesystem::path source;
        std::string station;
        UtcTime time;
        std::vector<std::byte> bytes;
    };
    Shipment laid_out(Way way, const std::string& station, UtcTime start,
                      std::vector<std::vector<std::byte>> pieces);

    std::filesystem::path drop_;
    std::mt19937 random_;
    int number_ = 0;  // over all shipments
    bool has_patience_ = false;
    std::vector<level2::Volume> patterns_;
    std::vector<Real> real_;
};

// Writes the whole shipment at once. Throws if that fails.
void deliver(const Shipment& shipment);

// A thread that writes the pieces of several shipments in turn.
class Feed {
  public:
    // The thread pauses for `pause` after each piece. It begins at most as many shipments as
    // allow() has allowed in total.
    Feed(Shipments shipments, std::uint32_t seed, std::chrono::microseconds pause);
    Feed(const Feed&) = delete;
    Feed& operator=(const Feed&) = delete;
    ~Feed();

    void allow(int shipments) { allowed_ = shipments; }
    // Finishes the shipments that have begun, closes all files, and returns the deliveries.
    std::vector<Delivered> finish();
    [[nodiscard]] int begun() const { return begun_; }

  private:
    struct Growing {
        Shipment shipment;
        std::size_t next = 0;
    };
    void run();
    void write_piece(Growing& growing);

    static constexpr std::size_t most_at_a_time = 6;
    Shipments shipments_;
    std::mt19937 random_;
    std::chrono::microseconds pause_;
    std::atomic<int> allowed_ = 0, begun_ = 0;
    std::atomic<bool> stopping_ = false;
    std::vector<Growing> growing_;
    std::vector<Delivered> delivered_;
    synth::PieceWriter closing_{0}, open_{64};
    std::thread thread_;
};

}  // namespace stormcellar::fault
