// retrieve/nowcast/nowcast_note.h -- the notes by which a grid says that it is a nowcast.
//
// Every nowcast has the first note, "nowcast, 30 minutes, by advection". The second note has the
// error that was measured (score_text()).
//
// Threads   Pure functions.
#pragma once

#include <array>
#include <span>
#include <string>

namespace stormcellar::retrieve {

[[nodiscard]] std::array<std::string, 2> nowcast_notes(double minutes, const std::string& score);

// The texts for the labels of a picture; both are empty if the grid is no nowcast.
struct NowcastNote {
    std::string nowcast;  // "nowcast, 30 minutes, by advection"
    std::string score;    // "measured on 3 hindcasts: CSI(35 dBZ) 0.62, persistence 0.48"
};
[[nodiscard]] NowcastNote nowcast_in_notes(std::span<const std::string> notes);

}  // namespace stormcellar::retrieve
