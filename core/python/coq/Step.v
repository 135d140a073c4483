(* The claims of a certificate, as equations over any `ops`, and a check of each whose soundness is proved here once.

   The page of the format, core/late/src/certificate.md, has the arrays, the actions and the claims. *)

Require Import ZArith List Bool Lia FMapPositive.
Require Import Liestep.Numbers.
Import ListNotations.

(* Data *)

(* An operation of a program, on registers. *)
Inductive operation := Plus (a b : positive) | Minus (a b : positive) | Times (a b : positive) | Over (a b : positive) | Negative (a : positive)
| Apply (f : function) (a : positive).

(* A program: registers are numbered from one, as the inputs (an array and an index), the literals n/d, and the operations. *)
Record program := {
  inputs : list (nat * nat);
  literals : list (Z * Z);
  operations : list operation;
  outputs : list positive
}.

(* An expression of matrices; a number is a matrix of one entry. `Let a b` is `b` with `a` in front of the names. *)
Inductive text :=
| Number (n d : Z) | Name (i : nat) | Let (a b : text)
| Sum (a b : text) | Difference (a b : text) | Product (a b : text) | Scaled (s a : text) | Quotient (a s : text)
| Opposite (a : text) | Turned (a : text) | Trace (a : text) | Inverse (a : text)
| At (f : function) (a : text) | Entry (i j : nat) (a : text) | Beside (a b : text) | Above (a b : text).

Record factor := {
  size : nat;
  is_product : bool;
  generators : list (list (list (Z * Z)));
  components : list (list (list (Z * Z))); (* matrices with ⟨D_j, E_k⟩ = δ_jk *)
  distance : option (nat * (Z * Z)) (* how far ŷ is from zero: so many columns, and a multiple of the sum of their entries' squares *)
}.

Inductive action :=
| Covector (k : nat) | Vector (k : nat) | Point (k : nat) | Contravariant (k : nat) | Covariant (k : nat) | Mixed (k : nat)
| Relative (to from : nat) | Configuration (k : nat) | Given.

(* What is carried along: its action, the shape of what is stored, and the parameter that is its value in space. *)
Record carried := { acts : action; shape : nat * nat; in_space : option nat }.

Record certificate := {
  factors : list factor;
  parameters : list (nat * nat); (* shapes *)
  advected : list carried;
  power : nat;
  in_products : bool; (* whether elements of the group among `advected` are products of increments *)
  energy : text;
  virtual : text;
  constants : program;
  target : program;
  newton : program;
  finish : program;
  seen : program
}.

Definition is_point (a : action) : bool := match a with Point _ => true | _ => false end.
Definition in_group (a : action) : bool := match a with Relative _ _ | Configuration _ => true | _ => false end.
Definition unknowns (c : certificate) : nat := list_sum (map (fun f => length (generators f)) (factors c)).
Definition squares (c : certificate) : nat := list_sum (map (fun f => size f * size f) (factors c)).

(* Whether an entry isn't the same in all elements of the group: in a product of generators it isn't zero. *)
Definition spread (n : nat) (s : nat -> nat -> bool) : list (list bool) :=
  map (fun i => map (fun j => s i j || existsb (fun k => s i k && s k j) (seq 0 n)) (seq 0 n)) (seq 0 n).
Definition read_off (l : list (list bool)) (i j : nat) : bool := nth j (nth i l []) false.
Definition in_generators (f : factor) (i j : nat) : bool :=
  existsb (fun e => negb (fst (nth j (nth i e []) (0, 1)) =? 0)%Z) (generators f).
Definition may_differ (c : certificate) (a : action) : nat -> nat -> bool :=
  match a with
  | Relative k _ | Configuration k =>
      match nth_error (factors c) k with
      | Some f => read_off (Nat.iter (size f) (fun l => spread (size f) (read_off l)) (spread (size f) (in_generators f)))
      | None => fun _ _ => true
      end
  | _ => fun _ _ => true
  end.

(* Which registers some outputs need. *)
Definition set := PositiveMap.t unit.
Definition has (s : set) (k : positive) : bool := PositiveMap.mem k s.
Definition read (op : operation) : list positive :=
  match op with Plus a b | Minus a b | Times a b | Over a b => [a; b] | Negative a | Apply _ a => [a] end.
Definition with_all (l : list positive) (s : set) : set := fold_left (fun s k => PositiveMap.add k tt s) l s.
Fixpoint needed (k : positive) (l : list operation) (s : set) : set :=
  match l with
  | [] => s
  | op :: r => let s := needed (Pos.succ k) r s in if has s k then with_all (read op) s else s
  end.

(* Matrices and programs *)

Section Functions.
Variable o : ops.
Notation num := (T o).
Notation row := (list (T o)).
Notation mat := (list (list (T o))).
Notation "a + b" := (add o a b).
Notation "a - b" := (sub o a b).
Notation "a * b" := (mul o a b).
Notation zero := (whole o 0).
Notation one := (whole o 1).

Definition ratio (z : Z * Z) : num := if (snd z =? 1)%Z then whole o (fst z) else div o (whole o (fst z)) (whole o (snd z)).
Fixpoint sum (n : nat) (f : nat -> num) : num := match n with 0 => zero | 1 => f 0 | S k => sum k f + f k end.
Definition at_ (k : nat) (l : row) : num := nth k l zero.
Definition tab (n m : nat) (f : nat -> nat -> num) : mat := map (fun i => map (f i) (seq 0 m)) (seq 0 n).
Definition entry (m : mat) (i j : nat) : num := at_ j (nth i m []).
Definition rows (m : mat) : nat := length m.
Definition columns (m : mat) : nat := length (nth 0 m []).
Definition pointwise (f : num -> num -> num) (a b : mat) : mat := tab (rows a) (columns a) (fun i j => f (entry a i j) (entry b i j)).
Definition madd : mat -> mat -> mat := pointwise (add o).
Definition msub : mat -> mat -> mat := pointwise (sub o).
Definition scaled (s : num) (a : mat) : mat := map (map (mul o s)) a.
Definition quotient (a : mat) (s : num) : mat := map (map (fun x => div o x s)) a.
Definition opposite (a : mat) : mat := map (map (opp o)) a.
Definition turned (a : mat) : mat := tab (columns a) (rows a) (fun i j => entry a j i).
Definition mmul (a b : mat) : mat := let t := turned b in
  tab (rows a) (columns b) (fun i j => let r := nth i a [] in let s := nth j t [] in sum (rows b) (fun k => at_ k r * at_ k s)).
Definition trace (a : mat) : num := sum (rows a) (fun i => entry a i i).
Definition inner (a b : mat) : num := sum (rows a) (fun i => sum (columns a) (fun j => entry a i j * entry b i j)).
Definition unit (n : nat) : mat := tab n n (fun i j => if Nat.eqb i j then one else zero).
Definition column (l : row) : mat := map (fun x => [x]) l.
Definition dot (a b : row) : num := sum (length a) (fun k => at_ k a * at_ k b).
Definition zip (f : num -> num -> num) (a b : row) : row := map (fun k => f (at_ k a) (at_ k b)) (seq 0 (length a)).
Definition signed (k : nat) (x : num) : num := if Nat.even k then x else opp o x.

(* The matrix without a row and a column, and the determinant by its first row. *)
Definition without (i j : nat) (a : mat) : mat :=
  tab (pred (rows a)) (pred (rows a)) (fun p q => entry a (if Nat.ltb p i then p else S p) (if Nat.ltb q j then q else S q)).
Fixpoint det (n : nat) (a : mat) : num :=
  match n with 0 => one | 1 => entry a 0 0 | S k => sum n (fun j => signed j (entry a 0 j * det k (without 0 j a))) end.
Definition inverse (n : nat) (a : mat) : mat :=
  quotient (tab n n (fun i j => signed (i + j)%nat (det (pred n) (without j i a)))) (det n a).

(* Parts of a list of numbers. *)
Fixpoint cut (shapes : list (nat * nat)) (l : row) : list mat :=
  match shapes with
  | [] => []
  | (n, m) :: s => tab n m (fun i j => at_ (i * m + j)%nat l) :: cut s (skipn (n * m)%nat l)
  end.
Fixpoint each (f : factor -> row -> mat) (l : list factor) (y : row) : list mat :=
  match l with
  | [] => []
  | x :: r => let n := length (generators x) in f x (firstn n y) :: each f r (skipn n y)
  end.
Fixpoint products (a b : list mat) : list mat := match a, b with x :: a, y :: b => mmul x y :: products a b | _, _ => [] end.

(* Programs *)

Definition registers := PositiveMap.t num.
Definition get (m : registers) (k : positive) : num := match PositiveMap.find k m with Some x => x | None => zero end.
Definition applied (m : registers) (op : operation) : num :=
  match op with
  | Plus a b => get m a + get m b
  | Minus a b => get m a - get m b
  | Times a b => get m a * get m b
  | Over a b => div o (get m a) (get m b)
  | Negative a => opp o (get m a)
  | Apply f a => call o f (get m a)
  end.
Fixpoint loaded (k : positive) (l : row) (m : registers) : registers :=
  match l with [] => m | x :: r => loaded (Pos.succ k) r (PositiveMap.add k x m) end.
Fixpoint executed (s : set) (k : positive) (l : list operation) (m : registers) : registers :=
  match l with
  | [] => m
  | op :: r =>
      let f := fun _ : Datatypes.unit => applied m op in
      executed s (Pos.succ k) r (PositiveMap.add k (if has s k then f tt else idle o f) m)
  end.
(* The first outputs and so many after them, where the first have any values, which are given, unless they are literals. Each run of
   the program is one of these. *)
Fixpoint freed (s : set) (k : positive) (l : list operation) (values m : registers) : registers :=
  match l with
  | [] => m
  | op :: r =>
      let f := fun _ : Datatypes.unit => applied m op in
      freed s (Pos.succ k) r values
        (PositiveMap.add k (match PositiveMap.find k values with Some x => x | None => if has s k then f tt else idle o f end) m)
  end.
Fixpoint placed (l : list positive) (values : row) (m : registers) : registers :=
  match l, values with k :: l, x :: values => placed l values (PositiveMap.add k x m) | _, _ => m end.
Definition run_after (p : program) (first count : nat) (values : row) (arrays : mat) : row :=
  let before := map (fun at2 => entry arrays (fst at2) (snd at2)) (inputs p) in let numbers := map ratio (literals p) in
  let j := Pos.of_succ_nat (length before) in let k := Pos.of_succ_nat (length before + length numbers) in
  let s := needed k (operations p) (with_all (firstn count (skipn first (outputs p))) (PositiveMap.empty _)) in
  let free m := placed (firstn first (outputs p)) values m in
  map (get (freed s k (operations p) (free (PositiveMap.empty _)) (loaded j numbers (free (loaded 1 before (PositiveMap.empty _))))))
    (firstn (first + count)%nat (outputs p)).
(* The outputs from one, so many. *)
Definition run (p : program) (first count : nat) (arrays : mat) : row :=
  let wanted := firstn count (skipn first (outputs p)) in
  let start := map (fun at2 => entry arrays (fst at2) (snd at2)) (inputs p) ++ map ratio (literals p) in
  let k := Pos.of_succ_nat (length start) in
  let s := needed k (operations p) (with_all wanted (PositiveMap.empty _)) in
  map (get (executed s k (operations p) (loaded 1 start (PositiveMap.empty _)))) wanted.

(* The group *)

Definition rational (m : list (list (Z * Z))) : mat := map (map ratio) m.
Definition hat (f : factor) (y : row) : mat :=
  let e := map rational (generators f) in
  tab (size f) (size f) (fun i j => sum (length e) (fun k => at_ k y * entry (nth k e []) i j)).
Definition cayley (n : nat) (hat_ : mat) : mat := mmul (inverse n (msub (unit n) hat_)) (madd (unit n) hat_).
(* F, and F⁻¹: by the chart of a product, a factor for each generator. *)
Definition single (f : factor) (sign : Z) (y : row) (k : nat) : mat :=
  cayley (size f) (scaled (whole o sign * at_ k y) (rational (nth k (generators f) []))).
Definition increment (f : factor) (y : row) : mat :=
  if is_product f then fold_left mmul (map (single f 1 y) (seq 0 (length (generators f)))) (unit (size f))
  else cayley (size f) (hat f y).
Definition back (f : factor) (y : row) : mat :=
  if is_product f then fold_left mmul (map (single f (-1) y) (rev (seq 0 (length (generators f))))) (unit (size f))
  else cayley (size f) (opposite (hat f y)).

(* F⁻¹·w *)
Definition moved (f g : list mat) (a : action) (w : mat) : mat :=
  let F k := nth k f [] in let G k := nth k g [] in
  match a with
  | Covector k => mmul (turned (F k)) w
  | Vector k | Point k => mmul (G k) w
  | Contravariant k => mmul (mmul (G k) w) (turned (G k))
  | Covariant k => mmul (mmul (turned (F k)) w) (F k)
  | Mixed k => mmul (mmul (G k) w) (F k)
  | Relative k from => mmul (mmul (G from) w) (F k)
  | Configuration k => mmul w (F k)
  | Given => w
  end.
Fixpoint all_moved (f g : list mat) (l : list carried) (w : list mat) : list mat :=
  match l, w with a :: l, x :: w => moved f g (acts a) x :: all_moved f g l w | _, _ => [] end.
(* A point has a last coordinate, one, which isn't stored. *)
Definition completed (a : carried) (m : mat) : mat := if is_point (acts a) then m ++ [[one]] else m.
Fixpoint stored (l : list carried) (w : list mat) : row :=
  match l, w with
  | a :: l, x :: w => (if is_point (acts a) then firstn (fst (shape a)) (concat x) else concat x) ++ stored l w
  | _, _ => []
  end.

(* ⟨Ad*_F ν, E_k⟩ = ⟨ν, F E_k F⁻¹⟩ *)
Fixpoint transported (l : list factor) (f g : list mat) (nu : row) : row :=
  match l, f, g with
  | x :: l, F :: f, G :: g =>
      let own := firstn (length (generators x)) nu in
      let pairs := map (fun e => let m := mmul (mmul F (rational e)) G in map (fun d => inner (rational d) m) (components x)) (generators x) in
      map (dot own) pairs ++ transported l f g (skipn (length (generators x)) nu)
  | _, _, _ => []
  end.

(* Texts *)

Fixpoint value (t : text) (names : list mat) : mat :=
  match t with
  | Number n d => [[ratio (n, d)]]
  | Name i => nth i names []
  | Let a b => value b (value a names :: names)
  | Sum a b => madd (value a names) (value b names)
  | Difference a b => msub (value a names) (value b names)
  | Product a b => mmul (value a names) (value b names)
  | Scaled s a => scaled (entry (value s names) 0 0) (value a names)
  | Quotient a s => quotient (value a names) (entry (value s names) 0 0)
  | Opposite a => opposite (value a names)
  | Turned a => turned (value a names)
  | Trace a => [[trace (value a names)]]
  | Inverse a => let x := value a names in inverse (rows x) x
  | At f a => [[call o f (entry (value a names) 0 0)]]
  | Entry i j a => [[entry (value a names) i j]]
  | Beside a b => let x := value a names in let y := value b names in
      tab (rows x) (columns x + columns y)%nat (fun i j => if Nat.ltb j (columns x) then entry x i j else entry y i (j - columns x)%nat)
  | Above a b => value a names ++ value b names
  end.
Definition number_of (t : text) (names : list mat) : num := entry (value t names) 0 0.
End Functions.

(* The names of a text: h, the parameters, F, F⁻¹, w, and the displacements before and after. *)
Definition scope (o : ops) (c : certificate) (h : T o) (p : list (T o)) (f g w : list (list (list (T o)))) (eta next : list (T o)) :=
  [[h]] :: cut o (parameters c) p ++ f ++ g ++ w ++ [column o eta; column o next].

(* The values of functions at an argument. An unknown stands for each, and what is known is the differential relation: a square root
   is x/below with x² = argument below²; of sine and cosine t is the tangent of half the angle; and so on. *)
Inductive rule :=
| RootAt (argument below square : text) (x : nat) | AngleAt (argument : text) (t : nat) | ExpAt (argument : text) (x : nat)
| LnAt (argument : text) (x : nat) | StumpffAt (argument : text) (t : nat) | RatioAt (argument : text) (x : nat) | AtOrigin.

Section Rules.
Variable o : ops.
Notation num := (T o).
Notation "a + b" := (add o a b).
Notation "a - b" := (sub o a b).
Notation "a * b" := (mul o a b).
Notation "a / b" := (div o a b).
Definition of_nat (k : nat) : num := whole o (Z.of_nat k).
Definition numbered (f : nat -> function) (x : num) (l : list num) : list (function * num * num) :=
  map (fun k => (f k, x, at_ o k l)) (seq 0 (length l)).
(* c_j, c_{j+1}, …, with `f` for j!: q c_{j+2} = 1/j! − c_j. *)
Fixpoint stumpffs (q : num) (n j : nat) (f : Z) (c d : num) : list num :=
  match n with 0 => [] | S n => c :: stumpffs q n (S j) (f * Z.of_nat (S j)) d ((ratio o (1, f)%Z - c) / q) end.
Fixpoint stumpffs_of_0 (n j : nat) (f : Z) : list num :=
  match n with 0 => [] | S n => ratio o (1, f)%Z :: stumpffs_of_0 n (S j) (f * Z.of_nat (S j)) end.
(* G⁽ᵏ⁾, G⁽ᵏ⁺¹⁾, …: u G⁽ᵏ⁺¹⁾ + (2k + 1) s G⁽ᵏ⁾ = 2k² G⁽ᵏ⁻¹⁾, which begins with u G′ + s G = 1. *)
Fixpoint ratios (s u : num) (n k : nat) (before g : num) : list num :=
  match n with
  | 0 => []
  | S n =>
      let right := match k with 0 => of_nat 1 | _ => of_nat (2 * k * k) * before end in
      g :: ratios s u n (S k) g ((right - of_nat (2 * k + 1) * s * g) / u)
  end.
Fixpoint ratios_of_0 (n k : nat) (g : num) : list num :=
  match n with 0 => [] | S n => g :: ratios_of_0 n (S k) (g * (of_nat (2 * S k * S k) / of_nat (2 * S k + 1))) end.
(* Unknowns are the entries of the last name. *)
Definition unknown (names : list (list (list num))) (k : nat) : num := entry o (nth 12 names []) k 0.
Definition calls (r : rule) (names : list (list (list num))) : list (function * num * num) :=
  let one := of_nat 1 in let of t := number_of o t names in let x := unknown names in
  match r with
  | RootAt a b _ k => [(Sqrt, of a, x k / of b)]
  | AngleAt a k =>
      let t := x k in let below := one + t * t in let s := of_nat 2 * t / below in let c := (one - t * t) / below in
      [(Sin, of a, s); (Cos, of a, c); (Sin, opp o (of a), opp o s); (Cos, opp o (of a), c)]
  | ExpAt a k => [(Exp, of a, x k); (Exp, opp o (of a), one / x k)]
  | LnAt a k => [(Ln, of a, x k)]
  | StumpffAt a k =>
      let q := of a in let t := x k in let below := one + q * t * t in
      numbered Stumpff q (stumpffs q 12 0 1 ((one - q * t * t) / below) (of_nat 2 * t / below))
  | RatioAt a k =>
      let z := of a in numbered LogRatio z (ratios (one - of_nat 2 * z) (of_nat 2 * z * (one - z)) 4 0 one (x k))
  | AtOrigin =>
      let zero := of_nat 0 in
      [(Sin, zero, zero); (Cos, zero, one); (Exp, zero, one); (Ln, one, zero)] ++
      numbered Stumpff zero (stumpffs_of_0 12 0 1) ++ numbered LogRatio zero (ratios_of_0 4 0 one)
  end.
End Rules.

(* Claims *)

Section Claims.
Variable o : ops.
Variable c : certificate.
Notation row := (list (T o)).
Notation mat := (list (list (T o))).
(* The numbers of all variables: h, parameters, y, a, μ, w, coordinates of g, history, displacements before and after, others of w
   and g, unknowns of functions, and any residual and Jacobian. *)
Variable v : mat.
Definition h := entry o v 0 0.
Definition p := nth 1 v [].
Definition y := nth 2 v [].
Definition a := nth 3 v [].
Definition mu := nth 4 v [].
Definition history := nth 7 v [].
Definition eta := nth 8 v [].
Definition eta_next := nth 9 v [].
Definition n := unknowns c.
Definition none : row := map (fun _ => whole o 0) (seq 0 n).
Definition ones : row := map (fun _ => whole o 1) (seq 0 n).
Definition axis (k : nat) : row := map (fun j => if Nat.eqb j k then whole o 1 else whole o 0) (seq 0 n).

Definition F := each o (increment o) (factors c) y.
Definition G := each o (back o) (factors c) y.
(* What is carried along: any numbers. For an element of the group these are its entries, but for those that all elements share; or, where
   a claim needs it, the product of increments. *)
Definition in_place (numbers coordinates : row) : list mat :=
  let f := each o (increment o) (factors c) coordinates in let g := each o (back o) (factors c) coordinates in
  map (fun x => let '(a, m) := x in
    if in_group (acts a) then
      if in_products c then moved o f g (acts a) (unit o (fst (shape a))) else
      let differs := may_differ c (acts a) in
      tab o (rows o m) (columns o m) (fun i j => if differs i j then entry o m i j else if Nat.eqb i j then whole o 1 else whole o 0)
    else completed o a m)
  (combine (advected c) (cut o (map shape (advected c)) numbers)).
Definition w := in_place (nth 5 v []) (nth 6 v []).
Definition other := in_place (nth 10 v []) (nth 11 v []).
Definition g := each o (increment o) (factors c) (nth 6 v []).
Definition g_back := each o (back o) (factors c) (nth 6 v []).
Definition flat (l : list mat) : row := concat (map (@concat _) l).

(* The programs, with inputs in the order of the page. *)
Definition arrays (y a mu : row) (w g : list mat) : mat :=
  [[h]; p; y; a; mu; stored o (advected c) w; flat g; history; []; run o (constants c) 0 (length (outputs (constants c))) [[h]; p]].
Definition kick (w : list mat) : row := run o (target c) 0 n (arrays none none none w []).
Definition system (first count : nat) (y a : row) (w : list mat) : row := run o (newton c) first count (arrays y a none w []).
Definition ended (first count : nat) (a mu : row) : row := run o (finish c) first count (arrays y a mu w g).

(* Dual numbers *)
Definition still (x : T o) : T (dual o) := (x, whole o 0).
Definition along (k : nat) : list (T (dual o)) := map (fun j => (whole o 0, if Nat.eqb j k then whole o 1 else whole o 0)) (seq 0 n).
Definition stills : list mat -> list (list (list (T (dual o)))) := map (map (map still)).
Definition near (sign : Z) (k : nat) : list (list (list (T (dual o)))) :=
  each (dual o) (fun f x => madd (dual o) (unit (dual o) (size f)) (scaled (dual o) (whole (dual o) sign) (hat (dual o) f x))) (factors c) (along k).
Definition lagrangian (f g w : list (list (list (T (dual o))))) : T o :=
  snd (number_of (dual o) (energy c) (scope (dual o) c (still h) (map still p) f g w [] [])).
Definition works (w : list mat) (eta next : row) : T o := number_of o (virtual c) (scope o c h p F G w eta next).
(* (2.7) and (2.6) *)
Definition before : row := map (fun k =>
  sub o (lagrangian (products (dual o) (near 1 k) (stills F)) (products (dual o) (stills G) (near (-1) k))
    (all_moved (dual o) (near (-1) k) (near 1 k) (advected c) (stills w))) (works w (axis k) none)) (seq 0 n).
Definition after : row := map (fun k =>
  add o (lagrangian (products (dual o) (stills F) (near 1 k)) (products (dual o) (near (-1) k) (stills G)) (stills w))
    (works w none (axis k))) (seq 0 n).

Definition equation := (row * row)%type.

(* F F⁻¹ = I, and (I − ŷ) F = I + ŷ by Cayley's chart. *)
Definition increments : equation :=
  let f := factors c in
  (flat (products o F G) ++ flat (each o (fun f x => if is_product f then [] else
     mmul o (msub o (unit o (size f)) (hat o f x)) (increment o f x)) f y),
   flat (map (fun x => unit o (size x)) f) ++ flat (each o (fun f x => if is_product f then [] else
     madd o (unit o (size f)) (hat o f x)) f y)).

Definition work : equation :=
  ([works w eta eta_next],
   [add o (dot o eta (map (fun k => works w (axis k) none) (seq 0 n))) (dot o eta_next (map (fun k => works w none (axis k)) (seq 0 n)))]).

Definition targets : equation :=
  let a := zip o (add o) mu (kick w) in (run o (target c) 0 (S n) (arrays none none mu w []), a ++ [dot o a a]).

(* S, of h and parameters alone, as its values at two places show; and S (1 + y·y)^power isn't zero. *)
Definition scale (w : list mat) : row := zip o (sub o) (system 0 n none none w) (system 0 n none ones w).
Definition weight : T o := fold_left (mul o) (map (fun _ => add o (whole o 1) (dot o y y)) (seq 0 (power c))) (whole o 1).
Definition scales : equation :=
  let each_ := weight :: scale w in
  (scale w ++ map (fun x => mul o x (div o (whole o 1) x)) each_, scale other ++ map (fun _ => whole o 1) each_).

Definition residual : equation :=
  (system 0 n y a w,
   zip o (mul o) (map (mul o weight) (scale w)) (zip o (sub o) (zip o (add o) before (kick w)) a)).

End Claims.

Section Derivatives.
Variable o : ops.
Variable c : certificate.
Variable v : list (list (T o)).
Notation n := (unknowns c).
Notation row := (list (T o)).
Definition still_ : list row -> list (list (T (dual o))) := map (map (still o)).
Definition jacobian : equation o :=
  let slope j := map snd (system (dual o) c (still_ v) 0 n (zip (dual o) (add (dual o)) (map (still o) (y o v)) (along o c j))
    (map (still o) (a o v)) (stills o (w o c v))) in
  let slopes := map slope (seq 0 n) in
  (system o c v n (n * n) (y o v) (a o v) (w o c v), concat (tab o n n (fun i j => at_ o i (nth j slopes [])))).

(* J u = r, whatever the residual and the Jacobian are. *)
Definition update : equation o :=
  let n := n in
  let all := run_after o (newton c) (n + n * n) n (nth 13 v []) (arrays o c v (y o v) (a o v) (none o c) (w o c v) []) in
  let r := firstn n all in let u := skipn (n + n * n) all in
  (map (fun i => dot o u (firstn n (skipn (n + i * n) all))) (seq 0 n), r).

Definition attitude : equation o := (ended o c v 0 (squares c) (a o v) (mu o v), flat o (products o (g o c v) (F o c v))).
Definition momentum : equation o :=
  let b := before o c v in
  (ended o c v (squares c) n (zip o (add o) b (kick o c v (w o c v))) b, after o c v).
(* For any target: that the momentum is its own part of it isn't needed. *)
Definition transport : equation o :=
  let x := eta o v in
  let found of := ended o c v (squares c) n (of (a o v)) (of (mu o v)) in
  (zip o (sub o) (found (fun m => zip o (add o) m x)) (found (fun m => m)), transported o (factors c) (F o c v) (G o c v) x).

Definition advected_ : equation o :=
  let after := stored o (advected c) (all_moved o (F o c v) (G o c v) (advected c) (w o c v)) in
  (ended o c v (squares c + n) (length after) (a o v) (mu o v), after).

Definition guess : equation o :=
  let last := firstn n (history o v) in let change := zip o (sub o) (y o v) last in
  let first := squares c + n + length (stored o (advected c) (w o c v)) in
  (ended o c v first (3 * n) (a o v) (mu o v),
   y o v ++ change ++ zip o (sub o) (zip o (add o) (y o v) (zip o (add o) change change)) (skipn n (history o v))).

(* The sum of all of μ⁺ and w⁺, and how far the increments are from the identity. *)
Definition checks : equation o :=
  let m := (n + length (stored o (advected c) (w o c v)))%nat in
  let far := flat o (each o (fun f y => match distance f with
    | Some (k, z) => [[mul o (ratio o z) (inner o (map (firstn k) (hat o f y)) (map (firstn k) (hat o f y)))]] | None => [] end) (factors c) (y o v)) in
  let all := ended o c v (squares c) (m + 3 * n + S (length far)) (a o v) (mu o v) in
  (skipn (m + 3 * n) all, fold_left (add o) (firstn m all) (whole o 0) :: far).

(* g⁻¹·w₀, with the identity where no parameter has w₀. *)
Definition at_attitude : equation o :=
  let fields := cut o (parameters c) (p o v) in
  let space := map (fun x => match in_space x with Some i => completed o x (nth i fields []) | None => unit o (fst (shape x)) end) (advected c) in
  let there := stored o (advected c) (all_moved o (g o c v) (g_back o c v) (advected c) space) in
  (run o (seen c) 0 (length there) (arrays o c v [] [] [] [] (g o c v)), there).
End Derivatives.

Definition claim := forall (o : ops) (c : certificate), list (list (T o)) -> equation o.
