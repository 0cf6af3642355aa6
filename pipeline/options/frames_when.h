// pipeline/options/frames_when.h -- when the frames of mosaics are made.
#pragma once

namespace stormcellar::pipeline {

enum class FramesWhen {
    volume_comes,  // at once, each frame that a volume changes, as the daemon does
    asked_for,     // only by MosaicMaker::make_again(): each frame of an archive is then made once
};

}  // namespace stormcellar::pipeline
