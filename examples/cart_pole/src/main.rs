//! Finds the friction of a simulated cart: `cargo run --package gyrocal-example-cart-pole`.

use gyrocal_example_cart_pole::simulation::{CartAndPole, STEP_S};
use gyrocal_example_cart_pole::{GUSTS, SENSORS, filter};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut plant = CartAndPole::new(1);
    let mut filter = filter()?;
    println!("time, s   friction of the cart, N s/m      of the pole, N m s");
    for step in 1..=2000 {
        filter.inputs_mut().drive = [plant.force()];
        let sample = plant.step();
        filter.predict(STEP_S, &GUSTS)?;
        filter.update(&sample, &SENSORS)?;
        if step % 400 == 0 {
            let [b, c] = [4, 5].map(|i| (filter.state()[i], filter.sigma(i)));
            let time = f64::from(step) * STEP_S;
            println!(
                "{time:7.1}   {:.4} ± {:.4}                {:.5} ± {:.5}",
                b.0, b.1, c.0, c.1
            );
        }
    }
    println!(
        "truth     {:.4}                         {:.5}",
        plant.state[4], plant.state[5]
    );
    Ok(())
}
