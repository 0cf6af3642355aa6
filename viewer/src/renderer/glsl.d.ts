// The build includes shaders as text.
declare module '*.glsl' {
    const text: string;
    export default text;
}
