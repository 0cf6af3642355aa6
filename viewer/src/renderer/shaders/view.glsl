// Declares the camera in drawn space, which is in meters from the middle of the grid, with exaggerated heights.
uniform vec2 size; // width and height of the picture, in pixels
uniform vec3 eye, right, up, forward;
uniform float scale; // focal length in pixels, or meters a pixel
