fn main() {
    // Trees that share a target folder must not share the generated header. Cargo takes them for one
    // package and their files for unchanged, so only the variable tells it that the tree is another.
    let tree = std::env::var("CARGO_MANIFEST_DIR").expect("cargo sets it");
    cxx_build::CFG.include_prefix = tree.trim_start_matches('/').to_owned().leak();
    cxx_build::bridge("src/lib.rs").std("c++20").compile("zenoh_bridge_cxx");
    println!("cargo:rerun-if-changed=src/lib.rs");
    println!("cargo:rerun-if-env-changed=BOLE_SOURCE_DIR");
}
