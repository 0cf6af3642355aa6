// Declares color tables as in answers of the server (/api/v1/tables).

export type Rgba = [number, number, number, number];

export interface ColorStop {
    from: number;
    color: Rgba;
    until: Rgba;
}
export interface ExtinctionPoint {
    value: number;
    per_km: number;
}
export interface ColorTable {
    name: string;
    moment: string;
    unit: string;
    stops: ColorStop[];
    end: number;
    bar_begin: number;
    range_folded: Rgba;
    extinction: ExtinctionPoint[];
}
