// pipeline/options/frames_when.h -- when the frames of mosaics are made.
#pragma once

namespace stormcellar::pipeline {

enum class FramesWhen {
    volume_comes,  // each that it changes, at once, as the daemon does
    asked_for,     // by MosaicMaker::make_again() alone: of an archive each is then made once
};

}  // namespace stormcellar::pipeline
