// The passes of one pane, with what they keep from picture to picture.

import { Graphics } from './graphics';
import { GridTextures } from './grid_textures';
import { LayerPasses } from './layer_passes';
import { SurfacePass } from './surface_pass';
import { VolumePass } from './volume_pass';

export class PanePasses {
    readonly layers: LayerPasses;
    readonly volume: VolumePass;
    readonly surfaces: SurfacePass;

    constructor(graphics: Graphics, grids: GridTextures) {
        this.layers = new LayerPasses(graphics);
        this.volume = new VolumePass(graphics, grids, this.layers);
        this.surfaces = new SurfacePass(graphics, grids, this.layers);
    }

    // Releases all textures.
    release(): void {
        this.layers.release();
        this.volume.release();
    }
}
