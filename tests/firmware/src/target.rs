//! The replay on the target.

use core::cell::UnsafeCell;

use gyrocal::Integration;
use gyrocal_board::{
    Argument, Counter, firmware, print, print_decimal, print_hexadecimal, used_by,
};
use gyrocal_firmware_test::{
    CASES, Digest, Filter, INTERVAL_S, Record, Report, answers, attitude, settings,
};

/// The filter, in memory that exists before the program: nothing of it is built on the stack.
struct Place(UnsafeCell<Filter>);

// SAFETY: there is one thread and no interrupt.
unsafe impl Sync for Place {}

static FILTER: Place = Place(UnsafeCell::new(Filter::unset()));

firmware!(run);

fn line(name: &str, number: u32) {
    print(name);
    print(" ");
    print_decimal(number);
    print("\n");
}

/// Ticks of 40 ns; QEMU is told to let an instruction take 64 ns.
fn instructions(ticks: u32) -> u32 {
    ticks * 5 / 8
}

fn run() {
    let argument = Argument::read();
    let integration = if argument.has("euler") {
        Integration::EULER
    } else {
        Integration::RK4
    };
    let rows = if argument.has("short") {
        1440
    } else {
        Record.len()
    };
    // SAFETY: the only reference, in the only function that takes it.
    let filter = unsafe { &mut *FILTER.0.get() };
    for (case, answer) in CASES.iter().zip(answers(filter)) {
        print("bad_input ");
        line(case, u32::from(answer));
    }
    line("size filter", size_of::<Filter>() as u32);
    line("size saved", Filter::SAVED_BYTES as u32);
    line("size record", Record.bytes() as u32);
    let nothing = used_by(|| ());
    let stack = |name, work: &mut dyn FnMut()| line(name, used_by(work).saturating_sub(nothing));
    let prior = settings(integration);
    stack("stack start", &mut || {
        if filter.start(&prior, &attitude()).is_err() {
            print("error 0 not started\n");
        }
    });
    let (mut nis, first) = (0.0, Record.sample(0));
    stack("stack update", &mut || {
        nis = filter
            .update(&first)
            .map_or(0.0, |innovation| innovation.nis);
    });
    let (mut digest, mut counts) = (Digest::default(), Counts::default());
    for row in 1..rows {
        let sample = Record.sample(row);
        if row % 500 == 1 {
            stack("stack step", &mut || {
                nis = filter
                    .step(INTERVAL_S, &sample)
                    .map_or(0.0, |found| found.nis);
            });
        } else {
            let empty = Counter::start().ticks();
            let counter = Counter::start();
            let result = filter.step(INTERVAL_S, &sample);
            counts.add(instructions(counter.ticks() - empty));
            match result {
                Ok(innovation) => nis = innovation.nis,
                Err(_) => return line("error", row as u32),
            }
        }
        digest.add_step(filter, nis);
        if row % 720 == 0 {
            print("digest ");
            print_decimal(row as u32);
            print(" ");
            print_hexadecimal(digest.0, 16);
            print("\n");
        }
    }
    line("steps", rows as u32 - 1);
    counts.print();
    let mut saved = [0; Filter::SAVED_BYTES];
    stack("stack save", &mut || {
        let _ = filter.save(&mut saved);
    });
    for (index, bits) in Report::of(filter, nis).bits().enumerate() {
        print("number ");
        print_decimal(index as u32);
        print(" ");
        print_hexadecimal(bits, 16);
        print("\n");
    }
    stack("stack restore", &mut || {
        let _ = filter.restore(&saved);
    });
    stack("stack coast", &mut || {
        let _ = filter.coast(600.0);
    });
}

/// Instructions of the steps after the first.
struct Counts {
    least: u32,
    most: u32,
    sum: u64,
    steps: u32,
}

impl Default for Counts {
    fn default() -> Self {
        Self {
            least: u32::MAX,
            most: 0,
            sum: 0,
            steps: 0,
        }
    }
}

impl Counts {
    fn add(&mut self, count: u32) {
        self.least = self.least.min(count);
        self.most = self.most.max(count);
        self.sum += u64::from(count);
        self.steps += 1;
    }

    fn print(&self) {
        line("instructions least", self.least);
        line("instructions most", self.most);
        let mean = self.sum.checked_div(u64::from(self.steps)).unwrap_or(0);
        line("instructions mean", mean as u32);
    }
}
