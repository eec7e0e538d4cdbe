//! Finds the biases of simulated gyros: `cargo run --package gyrocal-example-quadrotor`.

use gyrocal_example_quadrotor::simulation::{Hover, STEP_S};
use gyrocal_example_quadrotor::{GYROS, SENSORS, filter};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut plant = Hover::new(1);
    let mut filter = filter()?;
    println!("time, s   biases of the gyros, mrad/s, ± their sigma");
    for step in 1..=3000 {
        let (omega, sample) = plant.step();
        filter.inputs_mut().omega = omega;
        filter.predict(STEP_S, &GYROS)?;
        filter.update(&sample, &SENSORS)?;
        if step % 500 == 0 {
            let [x, y, z] = [3, 4, 5].map(|i| 1e3 * filter.state()[i]);
            let sigma = 1e3 * filter.sigma(3);
            println!(
                "{:7.1}   {x:7.2} {y:7.2} {z:7.2}  ± {sigma:.2}",
                f64::from(step) * STEP_S
            );
        }
    }
    let [x, y, z] = plant.bias.map(|bias| 1e3 * bias);
    println!("truth     {x:7.2} {y:7.2} {z:7.2}");
    Ok(())
}
