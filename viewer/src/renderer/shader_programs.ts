// Composes the programs of the files in shaders/. A program has variants: each flag is a #define, which includes code
// that only some scenes need.

import { azimuthSteps, noRadial } from '../fields/sweep_cone';
import { steepestFall } from '../fields/falls';
import { lookColumns, lookCount } from '../tables/looks';
import airFragment from 'shaders/air.fragment.glsl';
import facing from 'shaders/facing.glsl';
import fieldFragment from 'shaders/field.fragment.glsl';
import field from 'shaders/field.glsl';
import fullScreenVertex from 'shaders/full_screen.vertex.glsl';
import grid from 'shaders/grid.glsl';
import groundFragment from 'shaders/ground.fragment.glsl';
import hatch from 'shaders/hatch.glsl';
import light from 'shaders/light.glsl';
import lineFragment from 'shaders/line.fragment.glsl';
import lineVertex from 'shaders/line.vertex.glsl';
import litColor from 'shaders/lit_color.glsl';
import looks from 'shaders/looks.glsl';
import maximumFragment from 'shaders/maximum.fragment.glsl';
import prelude from 'shaders/prelude.glsl';
import rays from 'shaders/rays.glsl';
import solidDepth from 'shaders/solid_depth.glsl';
import solid from 'shaders/solid.glsl';
import solidVertex from 'shaders/solid.vertex.glsl';
import solidsShownFragment from 'shaders/solids_shown.fragment.glsl';
import surfaceFragment from 'shaders/surface.fragment.glsl';
import sweepFragment from 'shaders/sweep.fragment.glsl';
import tileVertex from 'shaders/tile.vertex.glsl';
import view from 'shaders/view.glsl';
import volumeFragment from 'shaders/volume.fragment.glsl';

// The files of a program, in the order in which they are read.
export interface ShaderProgram {
    name: string; // names the program and its variant
    defines: string[];
    vertex: string[];
    fragment: string[];
}

type Flags = Record<string, boolean | undefined>;
// eslint-disable-next-line @typescript-eslint/consistent-type-definitions -- an interface could not be passed as Flags
export type GridVariant = {
    isPerspective: boolean;
    hasUnevenLevels: boolean;
    hasHalved?: boolean; // bricks of halved grids may be in the atlas
};
export type VolumeVariant = GridVariant & {
    countsFetches?: boolean; // pixels show the number of texels that they read
    endsAtSolids?: boolean; // rays end at solid layers
    isLit?: boolean;
    measuresLight?: boolean; // pixels show lightness, factor of the light, and opacity
};
export type AirVariant = GridVariant & {
    hasHaze: boolean; // air that was not seen has a veil
    hasFolded: boolean;
};
export type SurfaceVariant = GridVariant & {
    isBelow: boolean; // the surface encloses values of at most the chosen value
    hasOther?: boolean; // another moment colors the surface
    isColumn?: boolean; // the surface has one color, through which the echo shows
};

export const radialsAcross = 1800; // length of a row in the texture of radials
const constants = [
    `LOOK_COLUMNS ${lookColumns}`,
    `LOOK_COUNT ${lookCount}`,
    `AZIMUTH_STEPS ${azimuthSteps}`,
    `RADIALS_ACROSS ${radialsAcross}`,
    `NO_RADIAL ${noRadial}u`,
    `STEEPEST_FALL ${steepestFall.toFixed(1)}`,
];

function program(name: string, flags: Flags, vertex: string[], fragment: string[]): ShaderProgram {
    const defines = Object.keys(flags)
        .filter((flag) => flags[flag])
        .map((flag) => flag.replace(/[A-Z]/g, '_$&').toUpperCase());
    const { isPerspective } = flags;
    const parts = isPerspective === undefined ? [name] : [name, isPerspective ? 'perspective' : 'parallel'];
    return {
        name: [...parts, ...defines.filter((define) => define !== 'IS_PERSPECTIVE')].join(', '),
        defines,
        vertex,
        fragment,
    };
}

// Returns the text of a shader, with version and #defines.
export function shaderText(files: string[], defines: string[]): string {
    const lines = [...constants, ...defines].map((define) => `#define ${define}`);
    return ['#version 300 es', ...lines, prelude, view, ...files].join('\n');
}

export const volumeProgram = (variant: VolumeVariant): ShaderProgram =>
    program(
        'volume',
        variant,
        [tileVertex],
        [
            rays,
            grid,
            ...(variant.endsAtSolids ? [solidDepth] : []),
            ...(variant.isLit ? [litColor, facing, light] : []),
            volumeFragment,
        ],
    );
export const groundProgram = (isPerspective: boolean): ShaderProgram =>
    program('ground', { isPerspective }, [fullScreenVertex], [rays, hatch, groundFragment]);
export const lineProgram: ShaderProgram = program('lines', {}, [lineVertex], [lineFragment]);

export const fieldProgram = (isPerspective: boolean): ShaderProgram =>
    program('field', { isPerspective }, [solidVertex], [rays, hatch, looks, solid, field, fieldFragment]);
export const sweepProgram = (isPerspective: boolean): ShaderProgram =>
    program('sweep', { isPerspective }, [solidVertex], [rays, hatch, looks, solid, sweepFragment]);
export const surfaceProgram = (variant: SurfaceVariant): ShaderProgram =>
    program('surface', variant, [fullScreenVertex], [rays, grid, looks, litColor, facing, surfaceFragment]);
export const solidsShownProgram: ShaderProgram = program('solids shown', {}, [fullScreenVertex], [solidsShownFragment]);

export const maximumProgram = (isPerspective: boolean): ShaderProgram =>
    program('maximum', { isPerspective }, [fullScreenVertex], [rays, hatch, looks, field, maximumFragment]);
export const airProgram = (variant: AirVariant): ShaderProgram =>
    program('air', variant, [fullScreenVertex], [rays, grid, airFragment]);
