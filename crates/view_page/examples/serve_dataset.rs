//! Serves the page that shows a dataset: `cargo run -p enfilade-view-page --example serve_dataset -- FOLDER [PORT]`.

use enfilade_serve::{Listen, serve};
use enfilade_view_page::{PAGE, Viewer, router};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("name the dataset's folder")?;
    let port = arguments.next().map_or(Ok(0), |port| port.parse())?;
    let listen = Listen { port, open: false, ..Listen::default() };
    serve(router(Viewer::open(folder)?), PAGE, &listen, |addresses| println!("{}", addresses.here))?;
    Ok(())
}
