use gyrocal::Integration;

use crate::reference::{TIE, dense_joseph, structured};

#[test]
fn no_worse_than_the_dense_joseph_filter_against_400_bits() {
    for integration in [Integration::EULER, Integration::RK4] {
        let (ours, dense) = (structured(integration), dense_joseph(integration));
        println!("{integration:?}\n  structured   {ours}\n  dense Joseph {dense}");
        // The reference was written from the equations: a disagreement about them would be
        // many orders larger than the rounding errors that are compared here.
        assert!(
            dense.worst_state < 1e-5,
            "{integration:?}: the reference is of another filter"
        );
        let (state, sigma) = (ours.state / dense.state, ours.sigma / dense.sigma);
        assert!(
            state <= TIE,
            "{integration:?}: errors of states are {state:.2} times larger"
        );
        assert!(
            sigma <= TIE,
            "{integration:?}: errors of sigmas are {sigma:.2} times larger"
        );
    }
}
