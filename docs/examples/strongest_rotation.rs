// Reads a Level II file from Rust by the C interface, and prints the strongest rotation of each low sweep: where
// azimuthal shear, the change of velocity from radial to radial, is largest. Tornadoes reach 0.02/s and more.
//   rustc --edition 2021 strongest_rotation.rs -l stormcellar && ./strongest_rotation FILE
use std::ffi::{CStr, CString};
use std::mem::size_of;
use std::os::raw::{c_char, c_void};
use std::ptr::{null, null_mut};

#[repr(C)]
struct Error {
    code: i32,
    message: [c_char; 1020],
}

#[repr(C)]
struct DeriveOptions {
    size: usize,
    dealias: *const c_char,
    storm_motion: *const c_char,
    quality: f64,
}

#[repr(C)]
#[derive(Default)]
struct VolumeFacts {
    size: usize,
    station: [c_char; 8],
    latitude_deg: f64,
    longitude_deg: f64,
    altitude_m: f64,
    start_ms: i64,
    vcp: i32,
    sweeps: i32,
    complete: i32,
    volumes: i32,
    problems: i32,
}

#[repr(C)]
#[derive(Default)]
struct SweepFacts {
    size: usize,
    elevation_deg: f64,
    fixed_angle_deg: f64,
    azimuth_spacing_deg: f64,
    start_ms: i64,
    end_ms: i64,
    elevation_number: i32,
    radials: i32,
    moments: i32,
}

#[repr(C)]
#[derive(Default)]
struct MomentFacts {
    size: usize,
    name: [c_char; 8],
    unit: [c_char; 16],
    gates: i32,
    first_gate_m: i32,
    gate_spacing_m: i32,
    code_bytes: i32,
    first_valid_code: i32,
    scale: f32,
    offset: f32,
}

#[repr(C)]
#[derive(Clone, Default)]
struct Radial {
    time_ms: i64,
    azimuth_deg: f32,
    elevation_deg: f32,
    nyquist_mps: f32,
    unambiguous_range_m: f32,
    status: i32,
    azimuth_number: i32,
}

#[link(name = "stormcellar")]
extern "C" {
    fn stormcellar_volume_open(path: *const c_char, options: *const c_void, volume: *mut *mut c_void, error: *mut Error) -> i32;
    fn stormcellar_volume_derive(
        volume: *const c_void, moments: *const c_char, options: *const DeriveOptions, derived: *mut *mut c_void, error: *mut Error,
    ) -> i32;
    fn stormcellar_volume_describe(volume: *const c_void, facts: *mut VolumeFacts, error: *mut Error) -> i32;
    fn stormcellar_volume_free(volume: *mut c_void);
    fn stormcellar_sweep_describe(volume: *const c_void, sweep: i32, facts: *mut SweepFacts, error: *mut Error) -> i32;
    fn stormcellar_sweep_radials(volume: *const c_void, sweep: i32, radials: *mut Radial, count: usize, error: *mut Error) -> i32;
    fn stormcellar_moment_find(volume: *const c_void, sweep: i32, name: *const c_char, moment: *mut i32, error: *mut Error) -> i32;
    fn stormcellar_moment_describe(volume: *const c_void, sweep: i32, moment: i32, facts: *mut MomentFacts, error: *mut Error) -> i32;
    fn stormcellar_moment_values(
        volume: *const c_void, sweep: i32, moment: i32, values: *mut f32, count: usize, error: *mut Error,
    ) -> i32;
}

// Makes a call, and turns its code and message into a Result.
fn call(function: impl FnOnce(*mut Error) -> i32) -> Result<(), String> {
    let mut error = Error { code: 0, message: [0; 1020] };
    if function(&mut error) == 0 {
        return Ok(());
    }
    Err(unsafe { CStr::from_ptr(error.message.as_ptr()) }.to_string_lossy().into_owned())
}

struct Volume(*mut c_void);

impl Drop for Volume {
    fn drop(&mut self) {
        unsafe { stormcellar_volume_free(self.0) }
    }
}

impl Volume {
    fn open(path: &str) -> Result<Volume, String> {
        let path = CString::new(path).map_err(|_| "the path has a zero byte".to_string())?;
        let mut volume = Volume(null_mut());
        call(|error| unsafe { stormcellar_volume_open(path.as_ptr(), null(), &mut volume.0, error) })?;
        Ok(volume)
    }

    // Derives azimuthal shear from dealiased velocities, and leaves out echo that is hardly weather.
    fn with_shear(&self) -> Result<Volume, String> {
        let moments = CString::new("AZSH").unwrap();
        let options = DeriveOptions { size: size_of::<DeriveOptions>(), dealias: null(), storm_motion: null(), quality: 0.5 };
        let mut derived = Volume(null_mut());
        call(|error| unsafe { stormcellar_volume_derive(self.0, moments.as_ptr(), &options, &mut derived.0, error) })?;
        Ok(derived)
    }

    fn facts(&self) -> Result<VolumeFacts, String> {
        let mut facts = VolumeFacts { size: size_of::<VolumeFacts>(), ..Default::default() };
        call(|error| unsafe { stormcellar_volume_describe(self.0, &mut facts, error) })?;
        Ok(facts)
    }

    // Prints the largest shear of a sweep between 10 and 150 km, if the sweep is low and has shear.
    fn print_rotation(&self, sweep: i32) -> Result<(), String> {
        let mut facts = SweepFacts { size: size_of::<SweepFacts>(), ..Default::default() };
        call(|error| unsafe { stormcellar_sweep_describe(self.0, sweep, &mut facts, error) })?;
        let name = CString::new("AZSH").unwrap();
        let mut moment = 0;
        let has_shear = call(|error| unsafe { stormcellar_moment_find(self.0, sweep, name.as_ptr(), &mut moment, error) }).is_ok();
        if !has_shear || facts.elevation_deg > 2.0 {
            return Ok(());
        }
        let mut gates = MomentFacts { size: size_of::<MomentFacts>(), ..Default::default() };
        call(|error| unsafe { stormcellar_moment_describe(self.0, sweep, moment, &mut gates, error) })?;
        let mut radials = vec![Radial::default(); facts.radials as usize];
        call(|error| unsafe { stormcellar_sweep_radials(self.0, sweep, radials.as_mut_ptr(), radials.len(), error) })?;
        let row = gates.gates as usize;
        let mut values = vec![0f32; radials.len() * row];
        call(|error| unsafe { stormcellar_moment_values(self.0, sweep, moment, values.as_mut_ptr(), values.len(), error) })?;
        let range_km = |gate: usize| (gates.first_gate_m as f64 + gates.gate_spacing_m as f64 * gate as f64) / 1000.0;
        // A gate without a value is NaN, which is never larger.
        let mut strongest = (0f32, 0usize);
        for (at, &value) in values.iter().enumerate() {
            if value > strongest.0 && (10.0..150.0).contains(&range_km(at % row)) {
                strongest = (value, at);
            }
        }
        println!(
            "elevation {:.1} degrees: shear of {:.4}/s at azimuth {:.0} degrees, range {:.0} km",
            facts.elevation_deg, strongest.0 / 1000.0, radials[strongest.1 / row].azimuth_deg, range_km(strongest.1 % row)
        );
        Ok(())
    }
}

fn run(path: &str) -> Result<(), String> {
    let volume = Volume::open(path)?.with_shear()?;
    let facts = volume.facts()?;
    println!("{}", unsafe { CStr::from_ptr(facts.station.as_ptr()) }.to_string_lossy());
    (0..facts.sweeps).try_for_each(|sweep| volume.print_rotation(sweep))
}

fn main() {
    let path = std::env::args().nth(1).unwrap_or_else(|| {
        eprintln!("usage: strongest_rotation FILE");
        std::process::exit(2);
    });
    if let Err(message) = run(&path) {
        eprintln!("{}", message);
        std::process::exit(1);
    }
}
