// Sets the default precision. Each shader begins with this file.
precision highp float;
precision highp int;
precision highp sampler3D;
precision highp usampler2D;
precision highp usampler3D;
