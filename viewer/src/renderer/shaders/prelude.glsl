// Precision of everything that a shader reads or computes; each shader begins with this file.
precision highp float;
precision highp int;
precision highp sampler3D;
precision highp usampler2D;
precision highp usampler3D;
