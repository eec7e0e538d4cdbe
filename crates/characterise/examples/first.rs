//! scratch
use gyrocal_characterise::{Cell, Method};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let cell = Cell::of_name(&args[1]).unwrap();
    let (from, to): (u64, u64) = (args[2].parse().unwrap(), args[3].parse().unwrap());
    for seed in from..to {
        let t = std::time::Instant::now();
        let case = cell.examine(seed, &Method::ALL);
        let s = t.elapsed().as_secs_f64();
        match case {
            Ok(c) => {
                println!("{}", serde_json::to_string(&(seed, s, &c)).unwrap());
            }
            Err(e) => println!("[{seed},{s},\"{e:?}\"]"),
        }
    }
}
