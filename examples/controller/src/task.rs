//! The task that runs the controller, and its memory.

use core::cell::UnsafeCell;

use gyrocal_board::{exit, firmware, print, print_decimal};

use crate::accelerometers;
use crate::controller::{Controller, Start};
use crate::kept::Kept;

/// Minutes between two saved states.
const SAVE_EVERY: usize = 60;
/// The minute at which power fails, for the example.
const RESET_AT: usize = 2000;
/// Minutes between two lines of text.
const TELL_EVERY: usize = 360;

/// Memory that exists before the program.
struct Memory {
    controller: UnsafeCell<Controller>,
    kept: UnsafeCell<Kept>,
}

// SAFETY: one task uses it, and no interrupt.
unsafe impl Sync for Memory {}

static MEMORY: Memory = Memory {
    controller: UnsafeCell::new(Controller::new()),
    kept: UnsafeCell::new(Kept::new()),
};

firmware!(run);

fn run() {
    // SAFETY: the only references, taken once.
    let (controller, kept) = unsafe { (&mut *MEMORY.controller.get(), &mut *MEMORY.kept.get()) };
    let mut minute = 0;
    loop {
        match session(controller, kept, minute) {
            // Power was back at once: the minute in which it failed is gone.
            Some(failed_at) => minute = failed_at,
            None => break,
        }
        *controller = Controller::new();
    }
    if !controller.is_healthy() {
        fail("the filter is not healthy at the end");
    }
    print("all minutes done, filter healthy\n");
}

/// From a start to the next reset, whose minute it returns, or to the end of the record.
fn session(controller: &mut Controller, kept: &mut Kept, from: usize) -> Option<usize> {
    let Ok(start) = controller.start(kept) else {
        fail("the filter did not start");
    };
    print(match start {
        Start::Cold => "cold start\n",
        Start::Warm => "warm start\n",
    });
    let mut minute = from;
    if start == Start::Cold {
        let first = accelerometers::sample(minute)?;
        if controller.first(&first).is_err() {
            fail("the first sample was not taken");
        }
    }
    loop {
        minute += 1;
        let sample_g = accelerometers::sample(minute)?;
        match controller.minute(&sample_g) {
            Ok(answer) => {
                if answer.refused.is_some() {
                    print_minute(minute);
                    print("sample refused, coasting\n");
                }
                if minute % TELL_EVERY == 0 {
                    tell(
                        minute,
                        &answer.rate_command_deg_per_h,
                        controller.is_healthy(),
                    );
                }
            }
            Err(_) => fail("the filter stopped"),
        }
        if minute % SAVE_EVERY == 0 && kept.save(controller.filter()).is_err() {
            fail("the state was not saved");
        }
        if from == 0 && minute == RESET_AT {
            print_minute(minute);
            print("reset\n");
            // The last state was saved on a full hour: its samples are taken again here. A
            // controller without them coasts over the time since.
            return Some(minute / SAVE_EVERY * SAVE_EVERY);
        }
    }
}

fn print_minute(minute: usize) {
    print("minute ");
    print_decimal(minute as u32);
    print(": ");
}

fn tell(minute: usize, command_deg_per_h: &[f32; 3], healthy: bool) {
    print_minute(minute);
    print("commands in mdeg/h:");
    for command in command_deg_per_h {
        let milli = (command * 1000.0) as i32;
        print(if milli < 0 { " -" } else { " " });
        print_decimal(milli.unsigned_abs());
    }
    print(if healthy {
        ", healthy\n"
    } else {
        ", NOT HEALTHY\n"
    });
}

fn fail(reason: &str) -> ! {
    print(reason);
    print("\n");
    exit(1)
}
